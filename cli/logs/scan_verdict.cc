#include "cli/logs/scan_verdict.h"

#include <fmt/format.h>

#include <cstddef>

#include "core/counted.h"

namespace ttf::cli::logs {

std::vector<std::string> reasons_for_no_box(const sensors::laser::LaserPreprocessingConfig& config,
                                            const sensors::laser::SegmentFates& fates) {
  if (fates.objects > 0) return {};
  std::vector<std::string> reasons;
  const auto dropped = [&](std::size_t count, const std::string& why) {
    if (count > 0) reasons.push_back(fmt::format("{} of {} {}", count, counted(fates.segments(), "segment"), why));
  };
  dropped(fates.small, fmt::format("have fewer than {} returns (fewest_points)", config.fewest_points));
  dropped(fates.single_beam, "are of a single beam");
  dropped(fates.large, fmt::format("are longer than {:g} m (longest_extent)", config.longest_extent_m));
  dropped(fates.thin, fmt::format("are thinner than {:g} m (thinnest)", config.shape.thinnest_m));
  dropped(fates.cut, "are cut by the field's edge or something nearer (cut_silhouettes, free_ends)");
  dropped(fates.rough,
          fmt::format("are rough: their best outline leaves more than {:g} m (roughest)", config.shape.roughest_m));
  return reasons;
}

}  // namespace ttf::cli::logs
