// Sweeps over the shortest drives.
#pragma once

#include <fmt/format.h>

#include <string>
#include <string_view>

#include "experiments/sweep/file.h"

namespace ttf::experiments::sweep {

// Two points, two paradigms; `more` goes behind.
inline std::string sweep_text(int replications, std::string_view more = "") {
  return fmt::format(
      "kind: sweep\n"
      "name: small\n"
      "question: Is it so?\n"
      "scenario: ../scenarios/dynamics.yaml\n"
      "seed: 3\n"
      "replications: {}\n"
      "paradigms:\n"
      "  adva: {{strategy: adva, set: {{duration: 700 ms, evaluate_from: 400 ms}}}}\n"
      "  tt: {{strategy: tt, set: {{duration: 700 ms, evaluate_from: 400 ms}}}}\n"
      "axes:\n"
      "  noise: {{keys: [world.acceleration_noise], values: [1, 40]}}\n"
      "measures: [position_rmse_truth, age_fused]\n"
      "{}",
      replications, more);
}
inline SweepFile small_sweep(int replications, std::string_view more = "") {
  return parse_sweep(sweep_text(replications, more), TTF_SOURCE_DIR "/experiments/small.yaml");
}

}  // namespace ttf::experiments::sweep
