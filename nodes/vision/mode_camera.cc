#include "nodes/vision/mode_camera.h"

#include <optional>
#include <utility>

namespace ttf::nodes::vision {

ModeCamera::ModeCamera(const schedules::model::Cluster& cluster, const schedules::model::Task& task,
                       const AdaptiveCameraConfig& config, std::vector<SharedCamera> cameras, const DetectionKey& key)
    : modes_(task.modes), choice_(task, config.modes),
      looking_(cluster, task, config, std::move(cameras), key, cluster.cycle() * task.activation.at.repetition) {
  for (const schedules::model::TaskMode& mode : modes_) {
    Frame& frame = frames_.emplace_back();
    frame.length = cluster.cycle() * mode.cycles;
    for (const schedules::model::ModeInstant& one : mode.instants)
      frame.letters += static_cast<char>((one.secondary ? 'a' : 'A') + static_cast<int>(one.camera));
  }
}

void ModeCamera::run(host::StepContext& context) {
  if (!context.global_time || !context.turn) return;  // pictures have no age
  looking_.read_regions(context);
  if (context.turn->place == 0) begin_frame(context);
  const schedules::model::ModeInstant& one = modes_[context.turn->mode].instants[context.turn->place];
  if (one.secondary && !looking_.has_region(one.camera)) return;
  std::optional<Look> look = looking_.look(context, one.camera, one.secondary, one.lasts);
  if (!look) return;
  look->record.frame = begun_ - 1;
  look->record.place = static_cast<std::uint16_t>(context.turn->place);
  looking_.write(context, *look);
}

void ModeCamera::begin_frame(host::StepContext& context) {
  CameraSet with_region = 0;
  for (std::size_t c = 0; c < looking_.cameras(); ++c)
    if (looking_.has_region(c)) with_region |= CameraSet{1} << c;
  context.turn->mode = choice_.of(with_region);
  const Frame& frame = frames_[context.turn->mode];
  context.sink->on(
      recording::records::SequencePlanned{context.stamp, begun_++, frame.letters, frame.length, frame.length});
}

}  // namespace ttf::nodes::vision
