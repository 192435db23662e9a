#include "schedules/timing/response/tdma.h"

#include <algorithm>
#include <numeric>

#include "core/check.h"
#include "schedules/timing/response/recurrence.h"

namespace ttf::schedules::timing::response {
namespace {

constexpr std::int64_t kMostSlotInstances = 2'000'000;

Int128 time_of(const TdmaSlot& slot, Int128 work) {
  return work + ceil_of(work, slot.length) * (slot.cycle - slot.length);
}

// F(q) + J - q T <= J + x + (x / s + 1) (L - s) - q T, with x = (q + 1) C, and x L / s grows no faster than q T.
Response slot_bound(const TdmaSlot& slot, const TdmaTask& task) {
  const Int128 service = ceil_of(static_cast<Int128>(task.work) * slot.cycle, slot.length);
  const Int128 bound = task.jitter + service + (slot.cycle - slot.length);
  if (bound > kLongestResponse) return {};
  return {Quality::kBound, static_cast<std::int64_t>(bound)};
}

}  // namespace

Response tdma_response(const TdmaSlot& slot, const TdmaTask& task) {
  TTF_CHECK(slot.length >= 1 && slot.length <= slot.cycle && slot.cycle <= kLongestArgument,
            "a slot of {} in a cycle of {}", slot.length, slot.cycle);
  for (const std::int64_t time : {task.period, task.work, task.jitter})
    TTF_CHECK(time >= 0 && time <= kLongestArgument, "a time of {}", time);
  TTF_CHECK(task.period >= 1 && task.work >= 1, "period {}, work {}", task.period, task.work);
  const Int128 needed = static_cast<Int128>(task.work) * slot.cycle;
  const Int128 given = static_cast<Int128>(task.period) * slot.length;
  if (needed > given) return {};
  // At full load F(q + n) = F(q) + n T for n = s / gcd(C, s).
  const std::int64_t repeats = slot.length / std::gcd(task.work, slot.length);
  Int128 longest = 0;
  for (std::int64_t q = 0;; ++q) {
    if (q == kMostSlotInstances) return slot_bound(slot, task);
    const Int128 end = time_of(slot, static_cast<Int128>(q + 1) * task.work);
    const Int128 arrival = static_cast<Int128>(q) * task.period - task.jitter;
    longest = std::max(longest, end - arrival);
    if (end <= arrival + task.period || (needed == given && q + 1 == repeats)) break;
  }
  if (longest > kLongestResponse) return {};
  return {Quality::kExact, static_cast<std::int64_t>(longest)};
}

}  // namespace ttf::schedules::timing::response
