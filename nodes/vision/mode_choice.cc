#include "nodes/vision/mode_choice.h"

#include <algorithm>
#include <bit>
#include <utility>

#include "core/check.h"
#include "schedules/model/ports.h"

namespace ttf::nodes::vision {

ModeChoice::ModeChoice(const schedules::model::Task& task, const std::vector<ModeOfRegions>& rows) {
  for (const schedules::model::TaskMode& mode : task.modes) {
    CameraSet cameras = 0;
    for (const schedules::model::ModeInstant& one : mode.instants)
      if (one.secondary) cameras |= CameraSet{1} << one.camera;
    secondaries_.push_back(cameras);
  }
  const auto ports = camera_ports(task);
  for (const ModeOfRegions& named : rows) {
    Row row;
    for (std::size_t c = 0; c < ports.size(); ++c)
      if (std::ranges::find(named.cameras, ports[c]->port) != named.cameras.end()) row.cameras |= CameraSet{1} << c;
    const auto mode = std::ranges::find(task.modes, named.mode, &schedules::model::TaskMode::name);
    TTF_CHECK(mode != task.modes.end(), "mode {} of task {}", named.mode, task.name);
    row.mode = static_cast<std::size_t>(mode - task.modes.begin());
    rows_.push_back(row);
  }
}

std::size_t ModeChoice::of(CameraSet with_region) const {
  for (const Row& row : rows_)
    if (row.cameras == with_region) return row.mode;
  const auto misfit = [&](std::size_t mode) {
    return std::pair{std::popcount(secondaries_[mode] & ~with_region),
                     std::popcount(with_region & ~secondaries_[mode])};
  };
  std::size_t best = 0;
  for (std::size_t mode = 1; mode < secondaries_.size(); ++mode)
    if (misfit(mode) < misfit(best)) best = mode;
  return best;
}

}  // namespace ttf::nodes::vision
