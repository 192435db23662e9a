#include "schedules/sequence/generator.h"

#include <algorithm>

#include "core/check.h"

namespace ttf::schedules::sequence {
namespace {

int rounded_up(int dividend, int divisor) { return (dividend + divisor - 1) / divisor; }

}  // namespace

int free_slots(const FrameRequest& request) {
  const Duration free = request.bound - request.primaries;
  if (request.interest.empty() || free <= Duration{} || request.secondary <= Duration{}) return 0;
  const std::int64_t whole = free.ns / request.secondary.ns;
  const std::int64_t slots = request.slots == SlotRule::kText ? whole + 1 : whole;
  return static_cast<int>(std::min<std::int64_t>(slots, kMostSecondaries));
}

int permuted(SlotOrder order, int place, int sensors) {
  if (order == SlotOrder::kReversed) return sensors + 1 - place;
  const int half = rounded_up(sensors, 2);
  return place % 2 == 1 ? (place + 1) / 2 : half + place / 2;
}

void generate(const FrameRequest& request, Sequence& sequence) {
  TTF_CHECK(request.sensors >= 1 && request.sensors <= kMostSensors, "{} sensors", request.sensors);
  TTF_CHECK(std::is_sorted(request.interest.begin(), request.interest.end(), std::less_equal<>{}), "interest twice");
  TTF_CHECK(request.interest.empty() || (request.interest.front() >= 0 && request.interest.back() < request.sensors),
            "interest {}..{} of {} sensors", request.interest.front(), request.interest.back(), request.sensors);
  const int slots = free_slots(request), columns = rounded_up(slots, request.sensors);
  const int regions = static_cast<int>(request.interest.size());
  sequence.clear();
  for (int sensor = 0; sensor < request.sensors; ++sensor) {
    sequence.push_back({sensor, false});
    for (int column = 0; column < columns; ++column) {
      const int slot = column * request.sensors + permuted(request.order, sensor + 1, request.sensors);
      if (slot > slots) continue;  // a blank
      const int region = rounded_up(slot * regions, slots);
      sequence.push_back({request.interest[static_cast<std::size_t>(region - 1)], true});
    }
  }
}

Sequence generated(const FrameRequest& request) {
  Sequence sequence;
  generate(request, sequence);
  return sequence;
}

}  // namespace ttf::schedules::sequence
