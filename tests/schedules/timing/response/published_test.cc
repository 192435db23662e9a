// Published examples, to the last digit.
#include <gtest/gtest.h>

#include <vector>

#include "schedules/timing/response/can.h"
#include "schedules/timing/response/fixed_priority.h"
#include "schedules/timing/response/priorities.h"
#include "schedules/timing/response/tdma.h"
#include "tests/schedules/timing/response/load_tests.h"
#include "tests/schedules/timing/simulated_resource.h"

namespace ttf::schedules::timing::response {
namespace {

TaskTimes published_task(std::int64_t work, std::int64_t period, std::int64_t deadline, std::int64_t blocking = 0,
                         std::int64_t jitter = 0) {
  return {.period = period, .work = work, .deadline = deadline, .jitter = jitter, .blocking = blocking, .offset = {}};
}

std::vector<std::int64_t> published_longest(const std::vector<Response>& responses) {
  std::vector<std::int64_t> longest;
  for (const Response& one : responses) longest.push_back(one.bounded() ? one.longest : -1);
  return longest;
}

// schedcat, tests/fp.py.
TEST(PublishedFixedPriority, FourTasksOfSchedcat) {
  const std::vector<TaskTimes> tasks{published_task(1, 4, 4), published_task(1, 5, 5), published_task(3, 9, 9),
                                     published_task(3, 18, 18)};
  const std::vector<Response> responses = preemptive(tasks);
  EXPECT_EQ(published_longest(responses), (std::vector<std::int64_t>{1, 2, 7, 18}));
  for (const Response& one : responses) EXPECT_EQ(one.quality, Quality::kExact);
}

// N. Audsley et al., "Applying new scheduling theory to static priority pre-emptive scheduling", 1993: the generic
// avionics platform, in microseconds. Their responses count from the release, ours from the arrival: J more.
TEST(PublishedFixedPriority, GenericAvionicsPlatform) {
  const std::vector<TaskTimes> tasks{
      published_task(51, 1'000, 1'000),
      published_task(3'000, 2'000'000, 5'000, 300),
      published_task(2'000, 25'000, 25'000, 600),
      published_task(5'000, 25'000, 25'000, 900),
      published_task(1'000, 40'000, 40'000, 1'350),
      published_task(3'000, 50'000, 50'000, 1'350),
      published_task(5'000, 50'000, 50'000, 750),
      published_task(8'000, 59'000, 59'000, 750),
      published_task(9'000, 80'000, 80'000, 1'350),
      published_task(2'000, 80'000, 80'000, 450),
      published_task(5'000, 100'000, 100'000, 1'050),
      published_task(1'000, 200'000, 200'000, 450, 1'000),
      published_task(3'000, 200'000, 200'000, 450),
      published_task(1'000, 200'000, 200'000, 450),
      published_task(1'000, 200'000, 200'000, 1'350),
      published_task(3'000, 1'000'000, 1'000'000),
      published_task(1'000, 1'000'000, 1'000'000),
      published_task(1'000, 1'000'000, 1'000'000),
  };
  const std::vector<Response> responses = preemptive(tasks);
  EXPECT_EQ(published_longest(responses),
            (std::vector<std::int64_t>{51, 3'504, 5'906, 11'512, 13'064, 16'217, 20'821, 36'637, 47'798, 48'949, 99'150,
                                       99'550 + 1'000, 140'641, 141'692, 143'694, 145'446, 146'497, 147'548}));
  for (std::size_t i = 0; i < tasks.size(); ++i)
    EXPECT_EQ(responses[i].quality, tasks[i].blocking > 0 ? Quality::kBound : Quality::kExact) << i;
}

// C. Liu, J. Layland 1973: n (2^(1/n) - 1).
TEST(PublishedLoads, LiuAndLaylandsTable) {
  const std::vector<double> published{1.0, 0.8284, 0.7798, 0.7568, 0.7435, 0.7348, 0.7286, 0.7241, 0.7205, 0.7177};
  for (std::size_t n = 1; n <= published.size(); ++n) EXPECT_NEAR(liu_layland_bound(n), published[n - 1], 5e-5) << n;
  EXPECT_NEAR(liu_layland_bound(20), 0.7053, 5e-5);
  EXPECT_NEAR(liu_layland_bound(1'000'000'000), 0.693147, 1e-6);
}

// Davis, Burns, Bril, Lukkien 2007, equation 1 and table 1.
TEST(PublishedCan, FrameLengths) {
  EXPECT_EQ(can_frame_bits(CanIdentifier::k11Bits, 0), 55);
  EXPECT_EQ(can_frame_bits(CanIdentifier::k11Bits, 8), 135);
  EXPECT_EQ(can_frame_bits(CanIdentifier::k29Bits, 0), 80);
  EXPECT_EQ(can_frame_bits(CanIdentifier::k29Bits, 8), 160);
  // Broster counts 52 + 10 s bits, and 3 of intermission apart from them.
  for (int bytes = 0; bytes <= 8; ++bytes)
    EXPECT_EQ(can_frame_bits(CanIdentifier::k11Bits, bytes), 52 + 10 * bytes + 3) << bytes;
  EXPECT_EQ(can_time_ns(125, 125'000), 1'000'000);
  EXPECT_EQ(can_time_ns(135, 500'000), 270'000);
  EXPECT_EQ(can_time_ns(1, 83'333), 12'001) << "rounded up";
}

// The same paper, section 3.2: three messages of 125 bits at 125 kbit/s, in microseconds. The first instance of C
// keeps its deadline, the second misses it. The analysis of 1994 saw the first one alone.
//
//   bus  |C of before|==A==|==B==|==C==|==A==|==B==|==C==|
//        0          1000  2000  3000  ...
std::vector<CanMessage> counterexample() {
  return {{.period = 2'500, .transmission = 1'000, .deadline = 2'500},
          {.period = 3'500, .transmission = 1'000, .deadline = 3'250},
          {.period = 3'500, .transmission = 1'000, .deadline = 3'250}};
}

TEST(PublishedCan, CounterexampleOfDavis) {
  const std::vector<CanMessage> messages = counterexample();
  const std::vector<Response> responses = can_responses({.bit = 8, .errors = {}}, messages);
  EXPECT_EQ(published_longest(responses), (std::vector<std::int64_t>{2'000, 3'000, 3'500}));
  for (const Response& one : responses) EXPECT_EQ(one.quality, Quality::kExact);
  EXPECT_TRUE(responses[1].keeps(messages[1].deadline));
  EXPECT_FALSE(responses[2].keeps(messages[2].deadline));
}

// The instances of C, queued at 0 and 3500, simulated: 3.0 and 3.5 ms.
TEST(PublishedCan, CounterexampleSimulated) {
  std::vector<SimulatedJob> jobs;
  for (std::int64_t n = 0; n < 4; ++n) jobs.push_back({0, n * 2'500, n * 2'500, 1'000});
  for (std::size_t task : {1U, 2U})
    for (std::int64_t n = 0; n < 3; ++n) jobs.push_back({task, n * 3'500, n * 3'500, 1'000});
  const std::vector<std::int64_t> ends = simulated_ends(jobs, Preemption::kNever);
  EXPECT_EQ(ends[7] - 0, 3'000);
  EXPECT_EQ(ends[8] - 3'500, 3'500);
}

// A published simulation from a common start: completions in bits, at 250 bits per millisecond. Three messages of 8
// bytes have periods of 3, 5 and 7 ms. Frames have 132 bits, and 3 more of intermission.
TEST(PublishedCan, CompletionsFromACommonStart) {
  const std::vector<std::int64_t> periods{750, 1'250, 1'750};
  std::vector<SimulatedJob> jobs;
  for (std::size_t task = 0; task < 3; ++task)
    for (std::int64_t n = 0; n < 2; ++n)
      jobs.push_back({task, n * periods[task], n * periods[task], can_frame_bits(CanIdentifier::k11Bits, 8)});
  std::vector<std::int64_t> completions = simulated_ends(jobs, Preemption::kNever);
  for (std::int64_t& one : completions) one -= 3;
  EXPECT_EQ(completions, (std::vector<std::int64_t>{132, 882, 267, 1'382, 402, 1'882}));
  // The analysis adds the blocking of a lower frame, where there is one.
  std::vector<CanMessage> messages;
  for (const std::int64_t period : periods)
    messages.push_back({.period = period, .transmission = 135, .deadline = period});
  EXPECT_EQ(published_longest(can_responses({.bit = 1, .errors = {}}, messages)),
            (std::vector<std::int64_t>{270, 405, 405}));
}

}  // namespace
}  // namespace ttf::schedules::timing::response
