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
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "core/check.h"
#include "core/time.h"
#include "recording/log/sensor_style.h"
#include "schedules/model/cluster.h"
#include "sensors/in_view.h"
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

// Rows of kinds, and the lists that follow from them.
template <IsKind... Kind> struct KindList {
  static constexpr std::array kKinds{Kind::kKind...};
  using OfEach = std::tuple<SensorsOfKind<Kind>...>;

  static consteval auto steps() {
    std::array<SensorSteps, (Kind::kSteps.size() + ...)> steps;
    auto end = steps.begin();
    ((end = std::ranges::copy(Kind::kSteps, end).out), ...);
    return steps;
  }
};

// The table: a place for each kind.
using Kinds = KindList<laser::Kind, stereo_camera::Kind, radar::Kind, mono_camera::Kind, odometry::Kind>;
static_assert(std::ranges::equal(Kinds::kKinds, schedules::model::kSensorKinds, {}, {},
                                 &schedules::model::SensorKindRow::kind),
              "each kind of schedules/model/sensor_kind.h has its place in the table, in the same order");

// The steps of all kinds.
inline constexpr auto kSteps = Kinds::steps();

class Sensors {
 public:
  // Defaulted in the source. Inline, each user would compile them.
  Sensors();
  Sensors(const Sensors&);
  Sensors(Sensors&&) noexcept;
  Sensors& operator=(const Sensors&);
  Sensors& operator=(Sensors&&) noexcept;
  ~Sensors();

  template <class Kind> SensorsOfKind<Kind>& of() { return std::get<SensorsOfKind<Kind>>(kinds_); }
  template <class Kind> const SensorsOfKind<Kind>& of() const { return std::get<SensorsOfKind<Kind>>(kinds_); }

  // Calls `visit` with the SensorsOfKind of each kind.
  template <class Self, class Visit> static void each(Self& sensors, const Visit& visit) {
    std::apply([&](auto&... kind) { (visit(kind), ...); }, sensors.kinds_);
  }
  // Returns what `visit` returns for the SensorsOfKind of one kind.
  template <std::size_t kPlace = 0, class Self, class Visit>
  static decltype(auto) of_kind(Self& sensors, schedules::model::SensorKind kind, const Visit& visit) {
    if constexpr (kPlace + 1 < Kinds::kKinds.size())
      if (kind != Kinds::kKinds[kPlace]) return of_kind<kPlace + 1>(sensors, kind, visit);
    TTF_CHECK(kind == Kinds::kKinds[kPlace], "sensor kind {}", static_cast<int>(kind));
    return visit(std::get<kPlace>(sensors.kinds_));
  }

  const Device& device_of(const schedules::model::Sensor& sensor) const;
  // Returns whether the sensor measures.
  bool enabled(const schedules::model::Sensor& sensor) const { return device_of(sensor).enabled; }
  // Returns what the fusion takes the emulated sensor to see.
  std::optional<fusion::sensors::Field> field_of(const schedules::model::Sensor& sensor) const;
  // Returns the span up to whose multiples its range rates are known [m/s].
  std::optional<double> rate_span(const schedules::model::Sensor& sensor) const;
  // Returns which returns its preprocessing joins.
  std::optional<fusion::sensors::Resolution> resolution(const schedules::model::Sensor& sensor) const;

 private:
  Kinds::OfEach kinds_;
};

// Returns the places and fields of the cluster's sensors that observe objects. One that is switched off reaches nothing.
std::vector<SensorView> views_of(const Sensors& sensors, const schedules::model::Cluster& cluster);

// Changes all sensors as this weather does.
void apply_weather(const sim::world::Weather& weather, Sensors& sensors);

// Returns how pictures show the cluster's sensors, by SensorId. It ends with the last one that the scenario styles.
std::vector<recording::log::SensorStyle> sensor_styles(const Sensors& sensors,
                                                       const schedules::model::Cluster& cluster);

// Returns the step of the task, as the scenario describes its sensor; null if no kind has it.
std::shared_ptr<nodes::host::Step> make_step(const Sensors& sensors, const EmulatorConfig& config);

}  // namespace ttf::sensors::kinds
