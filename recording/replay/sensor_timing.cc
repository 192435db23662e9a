#include "recording/replay/sensor_timing.h"

#include <algorithm>
#include <string>

#include "core/errors.h"

namespace ttf::recording::replay {
namespace {

// Returns the times of each sensor, ascending and without repetition.
std::vector<std::vector<GlobalTime>> times_measured(const RecordedLists& recorded) {
  std::vector<std::vector<GlobalTime>> times(recorded.sensors.size());
  for (const RecordedList& list : recorded.lists)
    if (list.copy == 0) times[index_of(list.id.sensor)].push_back(list.measured);
  for (auto& of_sensor : times) std::sort(of_sensor.begin(), of_sensor.end());
  return times;
}

// Rounds to the nearest whole number; both are above zero.
std::int64_t rounds(Duration whole, Duration part) { return (whole.ns + part.ns / 2) / part.ns; }

}  // namespace

std::vector<Duration> longest_delays(const RecordedLists& recorded) {
  std::vector<Duration> longest(recorded.sensors.size());
  for (const RecordedList& list : recorded.lists) {
    Duration& of_sensor = longest[index_of(list.id.sensor)];
    of_sensor = std::max(of_sensor, list.arrival - list.measured);
  }
  return longest;
}

std::optional<Duration> regular_period(const std::vector<GlobalTime>& times) {
  if (times.size() < 3) return std::nullopt;
  std::vector<Duration> steps;
  for (std::size_t i = 1; i < times.size(); ++i) steps.push_back(times[i] - times[i - 1]);
  std::nth_element(steps.begin(), steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2), steps.end());
  const Duration middle = steps[steps.size() / 2];
  if (middle > kPeriodAllowed.high) return std::nullopt;
  // Averages over the whole recording, for the best resolution.
  std::int64_t in_all = 0;
  for (std::size_t i = 1; i < times.size(); ++i) in_all += rounds(times[i] - times[i - 1], middle);
  if (in_all == 0) return std::nullopt;
  const Duration period{(times.back() - times.front()).ns / in_all};
  if (period < kPeriodAllowed.low || period > kPeriodAllowed.high) return std::nullopt;
  for (const GlobalTime time : times) {
    const Duration since = time - times.front();
    const Duration off = since - period * rounds(since, period);
    if (std::max(off, -off).ns > period.ns / 4) return std::nullopt;
  }
  return period;
}

bool measures_ranges(const RecordedLists& recorded, SensorId sensor) {
  return std::any_of(recorded.lists.begin(), recorded.lists.end(), [&](const RecordedList& list) {
    return list.id.sensor == sensor &&
           std::any_of(list.observations.begin(), list.observations.end(),
                       [](const fusion::sensors::Observation& observation) {
                         return observation.kind != fusion::sensors::ObservationKind::kPosition;
                       });
  });
}

std::vector<fusion::strategies::SensorTiming> sensor_timings(const RecordedLists& recorded, const ReplayConfig& config,
                                                             fusion::strategies::StrategyKind strategy) {
  const std::vector<Duration> longest = longest_delays(recorded);
  const std::vector<std::vector<GlobalTime>> times = times_measured(recorded);
  std::vector<fusion::strategies::SensorTiming> timings;
  const fusion::oosm::Kind late = config.tracker.late;
  const bool needs_schedule = fusion::strategies::row_of(strategy).relies_on == fusion::strategies::ReliesOn::kSchedule;
  const bool on_schedule = needs_schedule || late == fusion::oosm::Kind::kClone;
  bool any_scheduled = false;
  for (std::size_t s = 0; s < recorded.sensors.size(); ++s) {
    const SensorSetup& setup = config.sensors[s].second;
    fusion::strategies::SensorTiming timing{static_cast<SensorId>(s),
                                            fusion::strategies::Settling::after(setup.worst_delay.value_or(longest[s])),
                                            false,
                                            {},
                                            {},
                                            measures_ranges(recorded, static_cast<SensorId>(s))};
    const std::optional<Duration> period = setup.period ? setup.period : regular_period(times[s]);
    if (on_schedule && period && (setup.first || !times[s].empty())) {
      timing.scheduled = any_scheduled = true;
      timing.period = *period;
      timing.first = setup.first ? *setup.first : times[s].front();
    }
    timings.push_back(timing);
  }
  if (needs_schedule && !any_scheduled)
    throw InputError(
        {config.file.empty() ? "command line" : config.file, 0, "strategy", std::string(name_of(strategy)),
         "needs the period of at least one sensor: no period is given, and no sensor measures at regular instants"});
  const std::string refusal = fusion::strategies::late_refusal(strategy, late, timings);
  if (!refusal.empty())
    throw InputError({config.file, config.late_line, "tracker.late", std::string(name_of(late)), refusal});
  return timings;
}

}  // namespace ttf::recording::replay
