#include "fusion/strategies/late/announcements.h"

#include <algorithm>

namespace ttf::fusion::strategies::late {

Announcements::Announcements(std::span<const SensorTiming> sensors) {
  for (const SensorTiming& timing : sensors)
    if (timing.scheduled)
      sensors_.push_back({.sensor = timing.sensor, .instants = {.first = timing.first, .period = timing.period}});
  due_.reserve(sensors_.size() * static_cast<std::size_t>(kClones));
}

std::optional<GlobalTime> Announcements::instant_of(const sensors::ObservationList& list) const {
  for (const Sensor& own : sensors_)
    if (own.sensor == list.id.sensor) return own.instants.of(list.measured);
  return std::nullopt;
}

When Announcements::when(const sensors::ObservationList& list) const {
  if (const std::optional<GlobalTime> instant = instant_of(list))
    for (const Sensor& own : sensors_)
      if (own.sensor == list.id.sensor && own.next && *instant < *own.next)
        return {.stamp = stamp_of(own.sensor, *instant), .after = list.measured - *instant};
  return {.stamp = {list.measured, list.id}, .after = {}};
}

std::span<const oosm::Stamp> Announcements::pass(const sensors::ObservationList& list) {
  due_.clear();
  const std::optional<GlobalTime> mine = instant_of(list);
  const GlobalTime until = mine.value_or(list.measured);
  for (Sensor& other : sensors_) {
    const ScheduledInstants& instants = other.instants;
    if (until >= instants.first) {
      const GlobalTime newest = instants.newest_at(until);
      GlobalTime due =
          other.next ? std::max(*other.next, newest - instants.period * (kClones - 1)) : newest + instants.period;
      for (; due <= newest; due += instants.period)
        if (other.sensor != list.id.sensor || due != mine) due_.push_back(stamp_of(other.sensor, due));
      other.next = due;
    } else {
      other.next = instants.first;
    }
  }
  return due_;
}

}  // namespace ttf::fusion::strategies::late
