#include "sensors/mono_camera/emulator.h"

namespace ttf::sensors::mono_camera {

MonoCameraEmulator::MonoCameraEmulator(const EmulatorConfig& config, const MonoCameraConfig& camera)
    : Emulator(config), camera_(in_drive(camera, config.drive())),
      signals_(nodes::host::bind_element<5>(*config.cluster, config.written("raw"),
                                            {"left", "right", "bottom", "top", "class"})),
      raw_port_(*place_of_port(config.task->writes, "raw")), room_(config.scene->objects()) {
  camera_.max_boxes = config.written("raw").max_elements;
  boxes_.reserve(static_cast<std::size_t>(camera_.max_boxes));
  if (const auto port = place_of_port(config.task->writes, "marks")) {
    const schedules::model::PduLayout& layout = config.written("marks");
    marks_.emplace().port = *port;
    marks_->signals = nodes::host::bind_element<3>(*config.cluster, layout, {"offset", "heading", "curvature"});
    marks_->there.reserve(LaneMarkConfig::kMost);
    marks_->seen.reserve(static_cast<std::size_t>(layout.max_elements));
    marks_->truth.reserve(static_cast<std::size_t>(layout.max_elements));
  }
}

void MonoCameraEmulator::run(nodes::host::StepContext& context) {
  const TrueTime at = look(context, camera_.device);
  measure_mono_camera(camera_, states_, key(context), room_, boxes_, truth_);
  if (marks_) measure_marks(context, at);
  write_list(context.outputs[raw_port_], context.measurement, GlobalTime{}, signals_, boxes_, [](const MonoBox& box) {
    return std::array{box.left, box.right, box.bottom, box.top, static_cast<double>(box.seen_as)};
  });
  record(context);
}

void MonoCameraEmulator::measure_marks(nodes::host::StepContext& context, TrueTime at) {
  nodes::host::Output& out = context.outputs[marks_->port];
  marks_->there.clear();
  if (const sim::world::road::Road* road = config_.scene->road()) {
    const EgoState ego = config_.scene->ego_at(at);
    for (std::size_t m = 0; m < road->marks() && m < LaneMarkConfig::kMost; ++m) {
      const auto mark = road->mark_at(m, {ego.x, ego.y, ego.heading}, camera_.marks.ahead_m);
      marks_->there.push_back({mark.offset, mark.heading, mark.curvature});
    }
  }
  measure_lane_marks(camera_.marks, marks_->there, key(context), static_cast<std::size_t>(out.layout().max_elements),
                     marks_->seen, marks_->truth);
  write_list(out, context.measurement, GlobalTime{}, marks_->signals, marks_->seen, [](const LaneMark& mark) {
    return std::array{mark.offset, mark.heading, mark.curvature};
  });
}

}  // namespace ttf::sensors::mono_camera
