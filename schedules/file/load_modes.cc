#include "schedules/file/load_modes.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "core/counted.h"
#include "core/nearest.h"
#include "schedules/model/ports.h"
#include "schedules/sequence/detections.h"

namespace ttf::schedules::file {
namespace {

constexpr std::int64_t kLongestFrame = model::kMostModeCycles;

class ModeLoader {
 public:
  explicit ModeLoader(const model::Task& task) : task_(task), grid_(task.activation.at.repetition) {
    for (const model::PortBinding* port : camera_ports(task)) cameras_.push_back(port->port);
  }

  model::TaskMode load(const std::string& name, YamlMap& map) {
    model::TaskMode mode;
    mode.name = name;
    mode.line = map.line();
    mode.cycles = static_cast<int>(map.integer("frame", {1, kLongestFrame}, "cycles"));
    if (mode.cycles % grid_ != 0)
      map.fail("frame", fmt::format("must be a multiple of {}, the repetition of the activation", grid_));
    std::vector<YamlMap> entries = map.maps("detections");
    names_cameras_ = true;
    for (YamlMap& entry : entries) mode.instants.push_back(load_instant(entry, mode));
    if (entries.empty() && map.has("detections")) map.fail("detections", "must have at least one detection");
    if (!entries.empty() && names_cameras_) must_look_at_all(map, mode);
    map.finish();
    return mode;
  }

 private:
  model::ModeInstant load_instant(YamlMap& entry, const model::TaskMode& mode) {
    model::ModeInstant instant;
    instant.line = entry.line();
    instant.cycle = static_cast<int>(entry.integer("cycle", {0, kLongestFrame - 1}));
    const std::string camera = entry.text("camera");
    instant.secondary = entry.choice<bool>("look", {{"primary", false}, {"secondary", true}});
    instant.lasts = entry.duration("lasts", {task_.best_case, std::max(task_.best_case, task_.worst_case)});
    const auto found = std::ranges::find(cameras_, camera);
    if (found != cameras_.end())
      instant.camera = static_cast<std::size_t>(found - cameras_.begin());
    else
      names_cameras_ = false;
    if (found == cameras_.end() && entry.has("camera"))
      entry.fail("camera", cameras_.empty()
                               ? "needs a port of a camera among reads, and one for its objects among writes"
                               : fmt::format("must be a camera of the task: {}{}", joined(cameras_, " or "),
                                             did_you_mean(camera, cameras_)));
    if (const std::string why = misplaced(mode, instant.cycle); !why.empty()) {
      if (entry.has("cycle")) entry.fail("cycle", why);
      instant.cycle =
          mode.instants.empty() ? 0 : mode.instants.back().cycle;  // the next one is judged by the last right one
    }
    entry.finish();
    return instant;
  }

  // Returns why an instant may not be in this cycle, as the next one of the mode; nothing if it may.
  std::string misplaced(const model::TaskMode& mode, int cycle) const {
    if (cycle >= mode.cycles) return fmt::format("must be below the frame of {} cycles", mode.cycles);
    if (mode.instants.empty() && cycle != 0) return "must be 0: a frame begins with its first detection";
    if (!mode.instants.empty() && cycle <= mode.instants.back().cycle)
      return fmt::format("must be above {}, the cycle of the detection before", mode.instants.back().cycle);
    if (cycle % grid_ != 0) return fmt::format("must be a multiple of {}, the repetition of the activation", grid_);
    return {};
  }

  // A camera that a mode leaves out has no bound from an event on.
  void must_look_at_all(YamlMap& map, const model::TaskMode& mode) const {
    for (std::size_t c = 0; c < cameras_.size(); ++c)
      if (std::ranges::none_of(mode.instants, [c](const auto& one) { return one.camera == c && !one.secondary; }))
        map.fail("detections", fmt::format("must have a primary detection of {}", cameras_[c]));
  }

  const model::Task& task_;
  int grid_;
  std::vector<std::string> cameras_;
  bool names_cameras_ = true;  // each detection of the mode names one
};

}  // namespace

std::vector<model::TaskMode> load_modes(YamlMap& map, const model::Task& task) {
  if (task.activation.kind != model::ActivationKind::kModes)
    map.fail("modes", "must be absent: the task's activation is of another kind");
  std::vector<model::TaskMode> modes;
  ModeLoader loader(task);
  auto entries = map.named_maps("modes");
  if (entries.empty() && map.has("modes")) map.fail("modes", "must have at least one mode");
  if (camera_ports(task).size() > static_cast<std::size_t>(sequence::kMostSensors))
    map.fail("modes", fmt::format("must be of a task with at most {} cameras", sequence::kMostSensors));
  if (entries.size() > model::kMostModes)
    map.fail("modes", fmt::format("must have at most {} entries", model::kMostModes));
  for (auto& [name, entry] : entries) modes.push_back(loader.load(name, entry));
  return modes;
}

}  // namespace ttf::schedules::file
