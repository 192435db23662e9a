// A camera with one lens as a device. A camera of lanes has a second list, of the marks of lanes.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "sensors/emulator.h"
#include "sensors/mono_camera/model.h"

namespace ttf::sensors::mono_camera {

// The device's marks: the port, its signals, and room for a list.
struct MeasuredMarks {
  std::size_t port = 0;
  std::array<std::size_t, 3> signals{};
  std::vector<LaneMark> there, seen;
  std::vector<std::uint16_t> truth;
};

// Port `raw`: boxes as left, right, bottom, top [px] and class (sim::world::traffic::ObjectClass). Port `marks`, if the task has
// it: offset [m], heading [rad], curvature [1/m].
class MonoCameraEmulator final : public Emulator {
 public:
  MonoCameraEmulator(const EmulatorConfig& config, const MonoCameraConfig& camera);
  void run(nodes::host::StepContext& context) override;

 private:
  void measure_marks(nodes::host::StepContext& context, TrueTime at);

  MonoCameraConfig camera_;
  std::array<std::size_t, 5> signals_;
  std::size_t raw_port_;
  MonoCameraRoom room_;
  std::vector<MonoBox> boxes_;
  std::optional<MeasuredMarks> marks_;
};

}  // namespace ttf::sensors::mono_camera
