// The configuration of a replay: the tracker, the strategy and the sensors. In its YAML every key has a default:
//
//   strategy: adva                # buff, adva or tt
//   judgement: {cut_off: 4.0, order: 2.0}        # of GOSPA and OSPA (fusion/metrics/cut_off.h)
//   tracker: {process_noise: 4.0}                # the same keys as in a scenario (fusion/config/tracker_config.h)
//   sensors:                                     # those of the recording; absent: all sensors in it
//     laser: {position: 0.15, period: 100 ms, worst_delay: 10 ms}
//     radar: {range: 0.3, bearing: 0.03, range_rate: 0.3, period: 100 ms, first: 50 ms, worst_delay: 70 ms}
//     side:                                      # place and biases: fusion/sensors/known_sensor.h
//       {mounting: {x: 1.0, y: -0.9, heading: -1.57}, bias: {bearing: 0.01}, bias_sigma: {range: 0.1, time: 5 ms}}
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/strict_yaml.h"
#include "core/time.h"
#include "fusion/config/tracker_config.h"
#include "fusion/metrics/cut_off.h"
#include "fusion/sensors/known_sensor.h"
#include "fusion/strategies/strategy.h"

namespace ttf::recording::replay {

// Standard deviations for rows without a covariance or sigma of their own.
struct SensorNoise {
  double position = 0.5;             // [m], per axis
  double range = 0.5;                // [m]
  double bearing = 0.03;             // [rad]
  double range_rate = 0.5;           // [m/s]
  double heading = 0.2;              // [rad]
  double length = 0.5, width = 0.5;  // [m]
};

struct SensorSetup {
  SensorNoise noise;
  // Absent: estimated from the recording (recording/replay/sensor_timing.h).
  std::optional<Duration> worst_delay, period;
  std::optional<GlobalTime> first;     // an instant of the schedule; only with a period
  fusion::sensors::KnownSensor known;  // its place on the vehicle, and its biases
};

struct ReplayConfig {
  std::string file;  // empty: no file
  fusion::strategies::StrategyKind strategy = fusion::strategies::StrategyKind::kAdva;
  fusion::config::TrackerConfig tracker;                     // with the known sensors
  int late_line = 0;                                         // tracker.late's; 0: absent
  std::vector<std::pair<std::string, SensorSetup>> sensors;  // by SensorId; empty: all of the recording
  fusion::metrics::CutOff cut_off;                           // with which tracks are judged if the recording has truth
};

inline constexpr std::size_t kMostSensors = 100;
// The permitted range for every sigma of SensorNoise, in its unit.
inline constexpr Range<double> kSigmaAllowed{1e-3, 100.0}, kAngleSigmaAllowed{1e-4, 0.5};
inline constexpr Range<Duration> kDelayAllowed{Duration{}, Duration::milliseconds(3'600'000)};
inline constexpr Range<Duration> kPeriodAllowed{Duration::microseconds(1), Duration::milliseconds(3'600'000)};

// The sigma of that name and its permitted range; null for an unknown name.
struct NamedSigma {
  double* value = nullptr;
  Range<double> allowed{};
  const char* unit = "";
};
NamedSigma sigma_of(SensorNoise& noise, std::string_view name);
// Returns the names as in "must be position, range, ...".
std::string sigma_names();

// Keys missing for a sensor are as in `any`. `others` reads the top-level keys that the caller reads besides. Throws
// InputError.
using OtherKeys = std::function<void(YamlMap&)>;
ReplayConfig load_replay_config(const std::string& path, const SensorSetup& any, const OtherKeys& others = {});
ReplayConfig parse_replay_config(const std::string& text, const std::string& name, const SensorSetup& any);
ReplayConfig read_replay_config(const StrictYaml& yaml, const SensorSetup& any, const OtherKeys& others = {});

}  // namespace ttf::recording::replay
