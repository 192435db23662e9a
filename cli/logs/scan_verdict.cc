#include "cli/logs/scan_verdict.h"

#include <fmt/format.h>

#include <cmath>
#include <cstddef>
#include <numbers>

#include "core/counted.h"

namespace ttf::cli::logs {

std::vector<std::string> reasons_for_no_box(const recording::rows::RecordedScan& scan,
                                            const nodes::laser::LaserPreprocessingConfig& config,
                                            const nodes::laser::SegmentFates& fates) {
  if (fates.objects > 0) return {};
  std::size_t beyond = 0;
  for (const recording::rows::RecordedReturn& hit : scan.returns)
    beyond += std::abs(hit.azimuth_rad) > 2.0 * std::numbers::pi;
  std::vector<std::string> reasons;
  if (2 * beyond > scan.returns.size())
    reasons.push_back(fmt::format("{} of {} are beyond a whole turn of 6.283 rad: they may be in degrees", beyond,
                                  counted(scan.returns.size(), "azimuth")));
  const auto dropped = [&](std::size_t count, const std::string& why) {
    if (count > 0) reasons.push_back(fmt::format("{} of {} {}", count, counted(fates.segments(), "segment"), why));
  };
  dropped(fates.small, fmt::format("have fewer than {} returns (fewest_points)", config.fewest_points));
  dropped(fates.single_beam, "are of a single beam");
  dropped(fates.large, fmt::format("are longer than {:g} m (longest_extent)", config.longest_extent_m));
  return reasons;
}

}  // namespace ttf::cli::logs
