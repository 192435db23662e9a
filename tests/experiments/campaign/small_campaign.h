// The shortest campaigns on the shipped cluster.
#pragma once

#include <fmt/format.h>

#include <string>
#include <string_view>

#include "evaluation/faults/checks.h"
#include "experiments/campaign/campaign.h"

namespace ttf::experiments::campaign {

inline std::string campaign_text(int faults, std::string_view more = "") {
  return fmt::format(
      "kind: fault_campaign\n"
      "name: small\n"
      "cluster: ../schedules/flexray_demo.yaml\n"
      "faults: {}\n"
      "seed: 7\n"
      "start_up: 0.25\n"
      "cycles: {{steady_state: 60, start_up: 90}}\n"
      "restart_halted_after: 2\n"
      "variants:\n"
      "  guardian: {{topology: star, guardian: true, channels: AB}}\n"
      "  bus: {{topology: bus, guardian: false, channels: AB}}\n"
      "{}",
      faults, more);
}
inline CampaignFile small_campaign(int faults, std::string_view more = "") {
  return parse_campaign(campaign_text(faults, more), TTF_SOURCE_DIR "/experiments/small.yaml");
}
inline constexpr std::size_t kGuardian = 0, kBus = 1;  // its variants

inline bool seen(std::uint16_t checks, evaluation::faults::Check check) {
  return (checks >> static_cast<unsigned>(check) & 1u) != 0;
}
inline bool does(std::uint8_t harms, evaluation::faults::Harm harm) {
  return (harms >> static_cast<unsigned>(harm) & 1u) != 0;
}

}  // namespace ttf::experiments::campaign
