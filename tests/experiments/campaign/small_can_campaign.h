// A short campaign on the CAN of a shipped cluster.
#pragma once

#include <fmt/format.h>

#include <string>
#include <string_view>

#include "evaluation/faults/can_checks.h"
#include "experiments/campaign/can/bus.h"

namespace ttf::experiments::campaign {

inline std::string can_campaign_text(int faults, std::string_view more = "", std::string_view duration = "150 ms") {
  return fmt::format(
      "kind: fault_campaign\n"
      "name: small\n"
      "cluster: ../schedules/paper_event_triggered.yaml\n"
      "can: observation_can\n"
      "faults: {}\n"
      "seed: 7\n"
      "duration: {}\n"
      "variants:\n"
      "  automatic: {{recovery: automatic}}\n"
      "  host: {{recovery: host, restart_after: 20 ms}}\n"
      "  never: {{recovery: never}}\n"
      "{}",
      faults, duration, more);
}
inline CampaignFile small_can_campaign(int faults, std::string_view duration = "150 ms") {
  return parse_campaign(can_campaign_text(faults, "", duration), TTF_SOURCE_DIR "/experiments/small.yaml");
}
inline constexpr std::size_t kAutomatic = 0, kHost = 1, kNever = 2;  // its variants

inline bool seen(std::uint16_t checks, evaluation::faults::CanCheck check) {
  return (checks >> static_cast<unsigned>(check) & 1u) != 0;
}
inline bool does(std::uint8_t harms, evaluation::faults::CanHarm harm) {
  return (harms >> static_cast<unsigned>(harm) & 1u) != 0;
}

}  // namespace ttf::experiments::campaign
