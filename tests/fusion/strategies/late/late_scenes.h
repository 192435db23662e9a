// Late lists, taken in by a method and by rewinding, side by side.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "fusion/strategies/late/late_updates.h"
#include "fusion/tracks/timeline.h"
#include "tests/fusion/drives.h"

namespace ttf::fusion::strategies::late {

// Both measure every 40 ms, the second 20 ms after the first.
inline std::vector<SensorTiming> in_turn() { return {scheduled(0, 200, 0, 40), scheduled(1, 200, 20, 40)}; }

// No correct observation lies outside its gate, so results depend only on the lists taken in, and how.
inline config::TrackerConfig taking_late(oosm::Kind kind,
                                         config::MotionModel motion = config::MotionModel::kConstantVelocity) {
  config::TrackerConfig config = config_of(motion);
  config.late = kind;
  config.gate_probability = 0.999999;
  return config;
}

// Lists of a few objects far apart, in order. The first `all` show all objects, the others miss one in five.
inline std::vector<OwnedList> few_objects(std::uint64_t seed, std::uint32_t lists, std::uint32_t all = 8) {
  std::vector<OwnedList> result;
  for (std::uint32_t k = 0; k < lists; ++k) {
    const Lanes lanes{.objects = 4, .across = 2, .miss_probability = k < all ? 0.0 : 0.2, .seed = seed};
    result.push_back(list_of(static_cast<std::uint8_t>(k % 2), k / 2, at_ms(20 * k), lanes.see(at_ms(20 * k), k)));
  }
  return result;
}

// Each list's place in `lists`, in order of arrival. The first `in_time` are in order; each later one comes
// behind up to `most` others.
inline std::vector<std::size_t> drawn_order(RandomStream& stream, std::size_t lists, std::size_t in_time, int most) {
  std::vector<std::pair<std::int64_t, std::size_t>> arrivals;
  for (std::size_t i = 0; i < lists; ++i)
    arrivals.emplace_back(static_cast<std::int64_t>(i) + (i < in_time ? 0 : stream.integer(0, most)), i);
  std::sort(arrivals.begin(), arrivals.end());
  std::vector<std::size_t> order;
  for (const auto& arrival : arrivals) order.push_back(arrival.second);
  return order;
}
// The first of every `lag` + 1 lists after the first `in_time` comes last.
inline std::vector<std::size_t> one_late_order(std::size_t lists, std::size_t in_time, std::size_t lag) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < lists; ++i) order.push_back(i);
  for (std::size_t i = in_time; i + lag < lists; i += lag + 1)
    std::rotate(order.begin() + static_cast<std::ptrdiff_t>(i), order.begin() + static_cast<std::ptrdiff_t>(i) + 1,
                order.begin() + static_cast<std::ptrdiff_t>(i + lag) + 1);
  return order;
}

inline double relative_difference(const estimators::Estimate& a, const estimators::Estimate& b) {
  const estimators::Cartesian one = seen_as(a), other = seen_as(b);
  return std::max((one.x - other.x).norm() / other.x.norm(), (one.p - other.p).norm() / other.p.norm());
}

inline std::string name_of_kind(const testing::TestParamInfo<oosm::Kind>& info) {
  return std::string(oosm::name_of(info.param));
}

}  // namespace ttf::fusion::strategies::late
