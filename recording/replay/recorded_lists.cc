#include "recording/replay/recorded_lists.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <tuple>

#include "core/counted.h"
#include "core/random.h"
#include "fusion/filters/ldl.h"
#include "fusion/sensors/converted_position.h"
#include "fusion/strategies/strategy.h"

namespace ttf::recording::replay {
namespace {

using recording::rows::ObservationRow;

static_assert(kMostSensors < index_of(kNoSensor));

double squared(double value) { return value * value; }

void take_shape(fusion::sensors::Observation& out, const ObservationRow& row, const SensorNoise& noise) {
  out.has_heading = row.heading.has_value();
  out.heading = row.heading.value_or(0.0);
  out.sigma_heading = row.heading ? row.sigma_heading.value_or(noise.heading) : 0.0;
  out.has_length = row.length.has_value();
  out.length = row.length.value_or(0.0);
  out.sigma_length = row.length ? row.sigma_length.value_or(noise.length) : 0.0;
  out.has_width = row.width.has_value();
  out.width = row.width.value_or(0.0);
  out.sigma_width = row.width ? row.sigma_width.value_or(noise.width) : 0.0;
}

fusion::sensors::Observation observation_of(const ObservationRow& row, const SensorNoise& noise) {
  fusion::sensors::Observation out;
  const bool own = row.covariance.has_value();
  if (row.kind == ObservationRow::Kind::kRangeBearing) {
    out = fusion::sensors::converted_position(row.z[0], row.z[1], own ? std::sqrt((*row.covariance)[0]) : noise.range,
                                              own ? std::sqrt((*row.covariance)[2]) : noise.bearing);
  } else {
    const bool radar = row.kind == ObservationRow::Kind::kRangeBearingRate;
    out.kind =
        radar ? fusion::sensors::ObservationKind::kRangeBearingRate : fusion::sensors::ObservationKind::kPosition;
    out.z = {row.z[0], row.z[1], row.z[2]};
    if (own) {
      const std::array<double, 6>& c = *row.covariance;
      out.r << c[0], c[1], c[3], c[1], c[2], c[4], c[3], c[4], c[5];
    } else if (radar) {
      out.r.diagonal() << squared(noise.range), squared(noise.bearing), squared(noise.range_rate);
    } else {
      out.r.diagonal() << squared(noise.position), squared(noise.position), 0.0;
    }
  }
  take_shape(out, row, noise);
  return out;
}

// Alphabetical, whatever the order of rows: of equal scores the first class counts.
std::vector<std::string> classes_of(const std::vector<ObservationRow>& rows, const std::string& name) {
  std::set<std::string> seen;
  for (const ObservationRow& row : rows) {
    if (!row.class_name.empty()) seen.insert(row.class_name);
    if (seen.size() > fusion::sensors::kMostClasses)
      throw InputError({name, row.line, "class", row.class_name,
                        fmt::format("must be one of at most {} classes", fusion::sensors::kMostClasses)});
  }
  return {seen.begin(), seen.end()};
}

void take_unfiltered(fusion::sensors::Observation& out, const ObservationRow& row,
                     const std::vector<std::string>& classes) {
  out.third = {row.elevation.value_or(0.0), row.height.value_or(0.0), row.elevation.has_value(),
               row.height.has_value()};
  if (row.class_name.empty()) return;
  const auto place = std::lower_bound(classes.begin(), classes.end(), row.class_name);
  out.class_id = static_cast<fusion::sensors::ClassId>(place - classes.begin());
  out.score = row.score;
}

bool has_covariance(const fusion::sensors::Observation& observation) {
  if (fusion::sensors::dimension_of(observation.kind) == 3) return fusion::filters::positive_definite<3>(observation.r);
  return fusion::filters::positive_definite<2>(fusion::linear::Matrix<2>(observation.r.topLeftCorner<2, 2>()));
}

bool arrives_before(const RecordedList& a, const RecordedList& b) {
  return std::tuple(a.arrival, a.measured, a.id.sensor) < std::tuple(b.arrival, b.measured, b.id.sensor);
}

// Numbers the lists of each sensor by their time, and copies by their arrival.
void give_numbers(std::vector<RecordedList>& lists, std::size_t sensors) {
  std::stable_sort(lists.begin(), lists.end(), arrives_before);
  std::vector<std::map<GlobalTime, std::uint32_t>> times(sensors), copies(sensors);
  for (const RecordedList& list : lists) times[index_of(list.id.sensor)].emplace(list.measured, 0);
  for (auto& of_sensor : times) {
    std::uint32_t next = 0;
    for (auto& time : of_sensor) time.second = next++;
  }
  for (RecordedList& list : lists) {
    const std::size_t s = index_of(list.id.sensor);
    list.id.sequence = times[s][list.measured];
    list.copy = copies[s][list.measured]++;
  }
}

}  // namespace

void list_sensors(ReplayConfig& config, const std::vector<ObservationRow>& rows, const SensorSetup& any,
                  const std::string& name) {
  if (!config.sensors.empty()) return;
  std::set<std::string> seen;
  for (const ObservationRow& row : rows) {
    seen.insert(row.sensor);
    if (seen.size() > kMostSensors)
      throw InputError(
          {name, row.line, "sensor", row.sensor, fmt::format("must be one of at most {} sensors", kMostSensors)});
  }
  for (const std::string& sensor : seen) config.sensors.emplace_back(sensor, any);
}

RecordedLists recorded_lists_of(const std::vector<ObservationRow>& rows, const ReplayConfig& config,
                                const std::string& name, Findings& findings) {
  RecordedLists recorded;
  for (const auto& sensor : config.sensors) recorded.sensors.push_back(sensor.first);
  recorded.classes = classes_of(rows, name);
  struct Place {
    std::size_t sensor;
    std::int64_t time, arrival;
    auto operator<=>(const Place&) const = default;
  };
  std::map<Place, std::size_t> list_at;
  for (const ObservationRow& row : rows) {
    const auto known = std::find(recorded.sensors.begin(), recorded.sensors.end(), row.sensor);
    if (known == recorded.sensors.end()) {
      findings.add({name, row.line, "sensor", row.sensor,
                    fmt::format("must be a sensor of {}: {}", config.file, joined(recorded.sensors, " or "))});
      continue;
    }
    const auto s = static_cast<std::size_t>(known - recorded.sensors.begin());
    fusion::sensors::Observation observation = observation_of(row, config.sensors[s].second.noise);
    if (!has_covariance(observation)) {
      findings.add({name, row.line, "covariance", "", "must be positive definite beyond rounding errors"});
      continue;
    }
    take_unfiltered(observation, row, recorded.classes);
    fusion::sensors::place(observation, static_cast<SensorId>(s), config.sensors[s].second.known);
    const auto [place, is_new] = list_at.emplace(Place{s, row.time_ns, row.arrival_ns}, recorded.lists.size());
    if (is_new)
      recorded.lists.push_back(
          {{static_cast<SensorId>(s), 0}, GlobalTime{row.time_ns}, GlobalTime{row.arrival_ns}, 0, {}});
    std::vector<fusion::sensors::Observation>& list = recorded.lists[place->second].observations;
    if (list.size() == config.tracker.max_observations) {
      findings.add({name, row.line, "sensor", row.sensor,
                    fmt::format("must have at most {} observations at one time (max_observations of the tracker)",
                                config.tracker.max_observations)});
      continue;
    }
    list.push_back(observation);
  }
  give_numbers(recorded.lists, recorded.sensors.size());
  return recorded;
}

void simulate(RecordedLists& recorded, const SimulatedArrivals& simulated) {
  for (RecordedList& list : recorded.lists) {
    const std::size_t s = index_of(list.id.sensor);
    if (s >= simulated.delays.size() || !simulated.delays[s]) continue;
    RandomStream stream({.seed = simulated.seed,
                         .replication = list.copy,
                         .purpose = Purpose::kArrival,
                         .entity = static_cast<std::uint16_t>(s),
                         .index = list.id.sequence});
    list.arrival =
        list.measured + Duration{stream.integer(simulated.delays[s]->least.ns, simulated.delays[s]->most.ns)};
  }
  std::stable_sort(recorded.lists.begin(), recorded.lists.end(), arrives_before);
  if (simulated.shuffle <= 1) return;
  // An entity that no sensor has: their numbers are smaller.
  RandomStream stream({.seed = simulated.seed, .purpose = Purpose::kArrival, .entity = 0xffff});
  for (std::size_t from = 0; from < recorded.lists.size(); from += simulated.shuffle) {
    const std::size_t count = std::min(simulated.shuffle, recorded.lists.size() - from);
    const GlobalTime together = recorded.lists[from + count - 1].arrival;
    for (std::size_t i = 0; i < count; ++i) recorded.lists[from + i].arrival = together;
    for (std::size_t i = count - 1; i > 0; --i) {
      const auto other = static_cast<std::size_t>(stream.integer(0, static_cast<std::int64_t>(i)));
      std::swap(recorded.lists[from + i], recorded.lists[from + other]);
    }
  }
}

}  // namespace ttf::recording::replay
