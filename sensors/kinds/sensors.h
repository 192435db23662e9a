// The sensors of a scenario, by the names that they have in the cluster file, and the table of their kinds:
//
//   sensors:
//     laser: {range_sigma: 0.1}                      # every laser without an entry of its own
//     front_laser: {kind: laser, mounting: {x: 3.5}, range_bias: 0.2, preprocessing: {range_noise: 0.1},
//                   period: 80 ms, colour: green, marker: plus}
//   preprocessing:
//     laser: {range_noise: 0.1}                      # of every laser without its own
//
// A key that an entry omits has its documented default, whatever other entries say. The schedule says when a sensor
// measures. So `period` only repeats the schedule, and another one is refused.
#pragma once

#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/check.h"
#include "core/time.h"
#include "recording/log/sensor_style.h"
#include "schedules/model/cluster.h"
#include "sensors/kind.h"
#include "sensors/laser/kind.h"
#include "sensors/mono_camera/kind.h"
#include "sensors/odometry/kind.h"
#include "sensors/radar/kind.h"
#include "sensors/stereo_camera/kind.h"

namespace ttf::sensors::kinds {

template <IsKind Kind> struct SensorEntry {
  std::string name;
  typename Kind::Model model;
  std::optional<typename Kind::Preprocessing> preprocessing;  // absent: that of the kind
  std::optional<Duration> period;                             // absent: the schedule's, whatever it is
  recording::log::SensorStyle style;
};

template <IsKind KindOf> struct SensorsOfKind {
  using Kind = KindOf;
  using Entry = SensorEntry<Kind>;

  Entry usual;                                 // for every sensor of the kind without an entry of its own
  typename Kind::Preprocessing preprocessing;  // for every sensor of the kind without its own
  std::vector<Entry> own;

  const Entry& of(std::string_view name) const {
    for (const Entry& entry : own)
      if (entry.name == name) return entry;
    return usual;
  }
  const typename Kind::Preprocessing& preprocessing_of(std::string_view name) const {
    const Entry& entry = of(name);
    return entry.preprocessing ? *entry.preprocessing : preprocessing;
  }
};

// The table: a row is a member, and a line of each of the lists below.
struct Sensors {
  SensorsOfKind<laser::Kind> lasers;
  SensorsOfKind<stereo_camera::Kind> cameras;
  SensorsOfKind<radar::Kind> radars;
  SensorsOfKind<mono_camera::Kind> mono_cameras;
  SensorsOfKind<odometry::Kind> odometries;

  // Defaulted in the source. Inline, each user would compile them.
  Sensors();
  Sensors(const Sensors&);
  Sensors(Sensors&&) noexcept;
  Sensors& operator=(const Sensors&);
  Sensors& operator=(Sensors&&) noexcept;
  ~Sensors();

  // Calls `visit` with the SensorsOfKind of each kind.
  template <class Self, class Visit> static void each(Self& sensors, Visit visit) {
    visit(sensors.lasers);
    visit(sensors.cameras);
    visit(sensors.radars);
    visit(sensors.mono_cameras);
    visit(sensors.odometries);
  }
  // Returns what `visit` returns for the SensorsOfKind of one kind.
  template <class Self, class Visit>
  static auto of_kind(Self& sensors, schedules::model::SensorKind kind, Visit visit)
      -> decltype(visit(sensors.lasers)) {
    switch (kind) {
      case laser::Kind::kKind: return visit(sensors.lasers);
      case stereo_camera::Kind::kKind: return visit(sensors.cameras);
      case radar::Kind::kKind: return visit(sensors.radars);
      case mono_camera::Kind::kKind: return visit(sensors.mono_cameras);
      case odometry::Kind::kKind: return visit(sensors.odometries);
    }
    TTF_CHECK(false, "sensor kind {}", static_cast<int>(kind));
  }

  const Device& device_of(const schedules::model::Sensor& sensor) const;
  // Returns whether the sensor measures.
  bool enabled(const schedules::model::Sensor& sensor) const { return device_of(sensor).enabled; }
  // Returns what the fusion takes the emulated sensor to see.
  std::optional<fusion::sensors::Field> field_of(const schedules::model::Sensor& sensor) const;
  // Returns the span up to whose multiples its range rates are known [m/s].
  std::optional<double> rate_span(const schedules::model::Sensor& sensor) const;
};

// Changes all sensors as this weather does.
void meet(const sim::world::Weather& weather, Sensors& sensors);

// Returns how pictures show the cluster's sensors, by SensorId. It ends with the last one that the scenario styles.
std::vector<recording::log::SensorStyle> sensor_styles(const Sensors& sensors,
                                                       const schedules::model::Cluster& cluster);

template <IsKind... Kind> consteval auto steps_of() {
  static_assert(sizeof...(Kind) == schedules::model::kSensorKinds.size(), "each kind of sensor has its steps");
  std::array<SensorSteps, (Kind::kSteps.size() + ...)> steps;
  std::size_t n = 0;
  const auto add = [&](const SensorSteps& one) { steps[n++] = one; };
  (std::ranges::for_each(Kind::kSteps, add), ...);
  return steps;
}
// The steps of all kinds.
inline constexpr auto kSteps =
    steps_of<laser::Kind, stereo_camera::Kind, radar::Kind, mono_camera::Kind, odometry::Kind>();

// Returns the step of the task, as the scenario describes its sensor; null if no kind has it.
std::shared_ptr<nodes::host::Step> make_step(const Sensors& sensors, const EmulatorConfig& config);

}  // namespace ttf::sensors::kinds
