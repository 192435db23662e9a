// A slot of a time-division cycle, against a clock that ticks.
#include "schedules/timing/response/tdma.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace ttf::schedules::timing::response {
namespace {

// Serves FIFO in ticks. The slot is open while (tick + phase) mod cycle < length. Instances arrive at max(0, q T - J).
std::int64_t ticked_response(const TdmaSlot& slot, const TdmaTask& task, std::int64_t phase, std::int64_t instances) {
  std::int64_t longest = 0, tick = 0;
  for (std::int64_t q = 0; q < instances; ++q) {
    const std::int64_t arrival = q * task.period - task.jitter;
    tick = std::max({tick, arrival, std::int64_t{0}});
    for (std::int64_t left = task.work; left > 0; ++tick)
      if ((tick + phase) % slot.cycle < slot.length) --left;
    longest = std::max(longest, tick - arrival);
  }
  return longest;
}

// The slot of 3 in a cycle of 10: work 4 needs two slots.
//
//   arrival just behind a slot  ...|.......===|.......=  4 + 2 * 7 = 18
TEST(TdmaSlots, WorkNeedsWholeCycles) {
  EXPECT_EQ(tdma_response({3, 10}, {1'000, 4, 0}), (Response{Quality::kExact, 18}));
  EXPECT_EQ(tdma_response({3, 10}, {1'000, 3, 0}), (Response{Quality::kExact, 10}));
  EXPECT_EQ(tdma_response({10, 10}, {1'000, 7, 0}), (Response{Quality::kExact, 7})) << "the slot is the cycle";
}

TEST(TdmaSlots, AllPhasesOfSmallNumbers) {
  int full = 0, beyond = 0;
  for (std::int64_t cycle = 1; cycle <= 6; ++cycle)
    for (std::int64_t length = 1; length <= cycle; ++length)
      for (std::int64_t period = 1; period <= 8; ++period)
        for (std::int64_t work = 1; work <= 4; ++work)
          for (const std::int64_t jitter : {0, 3, 9}) {
            const TdmaSlot slot{length, cycle};
            const TdmaTask task{period, work, jitter};
            const Response response = tdma_response(slot, task);
            if (work * cycle > period * length) {
              ASSERT_EQ(response, Response{});
              ++beyond;
              continue;
            }
            std::int64_t worst = 0;
            for (std::int64_t phase = 0; phase < cycle; ++phase)
              worst = std::max(worst, ticked_response(slot, task, phase, 60));
            ASSERT_EQ(response, (Response{Quality::kExact, worst}))
                << length << "/" << cycle << ", " << work << "/" << period << ", jitter " << jitter;
            full += work * cycle == period * length ? 1 : 0;
          }
  EXPECT_GT(full, 50);
  EXPECT_GT(beyond, 500);
}

// Almost full load and a long jitter. The queue grows shorter by one tick an instance, for 10^16 instances.
TEST(TdmaSlots, EndlessBusyPeriodsHaveABound) {
  const std::int64_t t = 1'000'000'000'000;
  EXPECT_EQ(tdma_response({t / 2, t}, {t + 1, t / 2, kLongestArgument}),
            (Response{Quality::kBound, kLongestArgument + t + t / 2}))
      << "the first instance ends after J + t";
}

}  // namespace
}  // namespace ttf::schedules::timing::response
