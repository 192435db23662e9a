// Reaction time and data age of chains. A table is computed anew, and drawn chains are compared with data that flow.
#include "schedules/timing/chain/end_to_end.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <string>
#include <vector>

#include "core/random.h"
#include "tests/schedules/timing/chain/data_flow.h"

namespace ttf::schedules::timing::chain {
namespace {

using Offset = std::optional<Duration>;

constexpr Duration ns(std::int64_t n) { return Duration{n}; }

std::vector<Stage> let_chain(const std::vector<std::int64_t>& periods, const std::vector<std::int64_t>& offsets) {
  std::vector<Stage> stages;
  for (std::size_t s = 0; s < periods.size(); ++s)
    stages.push_back(let_stage("stage", ns(periods[s]), ns(offsets[s]), ns(periods[s])));
  return stages;
}

FlowTimes times_of(const EndToEnd& found) {
  return {.reaction = found.reaction.time.ns,
          .reduced_reaction = found.reduced_reaction.time.ns,
          .age = found.age ? found.age->time.ns : -1,
          .reduced_age = found.reduced_age ? found.reduced_age->time.ns : -1};
}

FlowTimes flown(const std::vector<Stage>& stages, std::int64_t window) {
  const std::vector<FlowStage> flow = listed(stages, window);
  return DataFlow(flow, 0, window).times();
}

Duration sum_of(const Figure& figure) {
  Duration sum{};
  for (const Share& share : figure.shares) sum += share.waits + share.runs + share.stays;
  return sum;
}

void expect_shares(const EndToEnd& found, const std::string& what) {
  for (const Figure* figure : {&found.reaction, &found.reduced_reaction, found.age ? &*found.age : nullptr,
                               found.reduced_age ? &*found.reduced_age : nullptr}) {
    if (figure == nullptr) continue;
    EXPECT_EQ(sum_of(*figure).ns, figure->time.ns) << what;
    for (const Share& share : figure->shares)
      EXPECT_TRUE(share.waits.ns >= 0 && share.runs.ns >= 0 && share.stays.ns >= 0) << what;
  }
}

TEST(EndToEnd, TableOfLogicalExecutionTime) {
  struct Row {
    std::vector<std::int64_t> periods, offsets;
    FlowTimes times;
  };
  const std::vector<Row> rows{
      {{10, 20}, {0, 0}, {50, 40, 50, 30}},           {{20, 10}, {0, 0}, {50, 30, 50, 40}},
      {{10, 15}, {0, 0}, {45, 35, 45, 30}},           {{5, 10, 20}, {0, 0, 0}, {55, 50, 55, 35}},
      {{10, 20, 50}, {0, 0, 0}, {140, 130, 140, 90}}, {{10, 20}, {0, 5}, {55, 45, 55, 35}}};
  for (const Row& row : rows) {
    const EndToEnd found = end_to_end(let_chain(row.periods, row.offsets));
    EXPECT_EQ(times_of(found), row.times) << row.periods.front() << " " << row.periods.back();
    EXPECT_TRUE(found.exact);
    expect_shares(found, "table");
  }
}

// The event comes just after 10. It is read at 20 and written at 30. The second stage reads at 40 and writes at 60.
TEST(EndToEnd, SharesOfTheStages) {
  const EndToEnd found = end_to_end(let_chain({10, 20}, {0, 0}));
  const Share& first = found.reaction.shares[0];
  const Share& second = found.reaction.shares[1];
  EXPECT_EQ((std::array{first.waits.ns, first.runs.ns, second.waits.ns, second.runs.ns}),
            (std::array<std::int64_t, 4>{10, 10, 10, 20}));
  EXPECT_EQ(found.age->shares[1].stays.ns, 20);
  EXPECT_EQ(found.age->shares[0].waits.ns, 0);
}

// Chains of known phases. Periods, offsets, times of jobs and kinds of stages are drawn.
class Drawn {
 public:
  explicit Drawn(std::uint32_t index) : stream_({.seed = 7, .purpose = Purpose::kTest, .index = index}) {
    const std::int64_t count = stream_.integer(1, 5);
    for (std::int64_t s = 0; s < count; ++s) stages.push_back(stage(s == 0));
    for (const Stage& one : stages)
      if (!one.activated) hyperperiod = std::lcm(hyperperiod, one.cycle.ns);
  }

  // Hyperperiods that are longer than any age and any offset.
  std::int64_t window() const {
    std::int64_t longest = 70;
    for (const Stage& one : stages) longest += one.activated ? one.longest.ns : one.cycle.ns + 70;
    return hyperperiod * (1 + longest / hyperperiod);
  }

  std::vector<Stage> stages;
  std::int64_t hyperperiod = 1;

 private:
  Stage stage(bool first) {
    constexpr std::array<std::int64_t, 11> kPeriods{2, 3, 4, 5, 6, 8, 10, 12, 15, 20, 30};
    const std::int64_t period = kPeriods[static_cast<std::size_t>(stream_.integer(0, 10))];
    const Offset offset = ns(stream_.integer(-5, 2 * period));
    const std::int64_t kind = stream_.integer(first ? 1 : 0, 3);
    if (kind == 0) return activated_stage("activated", ns(stream_.integer(0, 12)), true);
    if (kind == 1) return let_stage("let", ns(period), offset, ns(stream_.integer(1, period)));
    Stage sampled = sampled_stage("sampled", ns(period), offset, ns(stream_.integer(0, 2 * period)));
    sampled.exact = true;
    if (kind == 3) several_jobs(sampled, period);
    return sampled;
  }

  // Up to four jobs a cycle at drawn instants.
  void several_jobs(Stage& stage, std::int64_t period) {
    stage.jobs.clear();
    std::int64_t reads = stream_.integer(0, period), writes = reads;
    const std::int64_t first = reads;
    std::int64_t first_write = 0;
    for (std::int64_t j = stream_.integer(1, 4); j > 0; --j) {
      writes = std::max(writes, reads + stream_.integer(0, period));
      if (stage.jobs.empty()) first_write = writes;
      if (reads >= first + period || writes > first_write + period) break;
      stage.jobs.push_back({.reads = ns(reads), .writes = ns(writes)});
      reads += stream_.integer(1, period);
    }
  }

  RandomStream stream_;
};

TEST(EndToEnd, DrawnChainsAgainstDataThatFlow) {
  for (std::uint32_t index = 0; index < 1000; ++index) {
    const Drawn drawn(index);
    const EndToEnd found = end_to_end(drawn.stages);
    const std::int64_t window = drawn.window();
    ASSERT_EQ(times_of(found), flown(drawn.stages, window)) << "chain " << index;
    ASSERT_TRUE(found.exact);
    ASSERT_EQ(found.reaction.time, found.age->time) << "chain " << index;  // MRT = MDA
    ASSERT_LE(found.reduced_reaction.time, found.reaction.time);
    ASSERT_LE(found.reduced_age->time, found.age->time);
    expect_shares(found, "chain " + std::to_string(index));
  }
}

std::vector<Stage> of_any_phase(std::vector<Stage> stages) {
  for (Stage& stage : stages) stage.origin.reset();
  return stages;
}

// The stage's jobs over a longer cycle, in order. Each lies between its earliest reading and its latest writing.
Stage varied(const Stage& stage, std::int64_t cycle, RandomStream& stream) {
  Stage result = stage;
  if (stage.activated) {
    result.longest = ns(stream.integer(0, stage.longest.ns));
    return result;
  }
  result.jobs.clear();
  result.cycle = ns(cycle);
  for (std::int64_t from = 0; from < cycle; from += stage.cycle.ns)
    for (const Job& job : stage.jobs) {
      Job one{.reads = ns(from + stream.integer(job.reads.ns, job.writes.ns)), .writes = {}};
      one.reads = std::min(one.reads, result.jobs.empty() ? one.reads : result.jobs[0].reads + result.cycle - ns(1));
      if (!result.jobs.empty()) one.reads = std::max(one.reads, result.jobs.back().reads);
      one.writes = ns(stream.integer(one.reads.ns, from + job.writes.ns));
      if (!result.jobs.empty()) {
        one.writes = std::max(one.writes, result.jobs.back().writes);
        one.writes = std::min(one.writes, result.jobs[0].writes + result.cycle);
      }
      result.jobs.push_back(one);
    }
  return result;
}

TEST(EndToEnd, JobsThatVaryStayBelow) {
  RandomStream stream({.seed = 8, .purpose = Purpose::kTest});
  std::size_t judged = 0;
  for (std::uint32_t index = 0; index < 600; ++index) {
    const Drawn drawn(index);
    const std::int64_t window = drawn.window();
    std::vector<Stage> stages;
    for (const Stage& stage : drawn.stages) stages.push_back(varied(stage, window, stream));
    const bool sound = std::ranges::all_of(stages, [](const Stage& stage) {
      return std::ranges::all_of(stage.jobs, [](const Job& job) { return job.reads <= job.writes; });
    });
    if (!sound) continue;  // the last job of a cycle had to come before the first of the next
    ++judged;
    const FlowTimes most = times_of(end_to_end(drawn.stages));
    const FlowTimes some = flown(stages, window);
    ASSERT_LE(some.reaction, most.reaction) << "chain " << index;
    ASSERT_LE(some.reduced_reaction, most.reduced_reaction);
    ASSERT_LE(some.age, most.age);
    ASSERT_LE(some.reduced_age, most.reduced_age);
  }
  EXPECT_GT(judged, 450U);
}

// Davare's sum(T + R), for stages of one job a cycle. An activated one adds its own time.
std::int64_t davare(const std::vector<Stage>& stages) {
  std::int64_t sum = 0;
  for (const Stage& stage : stages)
    sum += stage.activated ? stage.longest.ns : (stage.cycle + stage.jobs[0].writes - stage.jobs[0].reads).ns;
  return sum;
}

TEST(EndToEnd, BoundsAreNeverBelow) {
  for (std::uint32_t index = 0; index < 6000; ++index) {
    const Drawn drawn(index);
    const EndToEnd known = end_to_end(drawn.stages);
    const EndToEnd bound = end_to_end(of_any_phase(drawn.stages));
    ASSERT_EQ(known.reaction.time, known.age->time) << "chain " << index;  // MRT = MDA
    ASSERT_LE(known.reaction.time, bound.reaction.time) << "chain " << index;
    ASSERT_LE(known.reduced_reaction.time, bound.reduced_reaction.time);
    ASSERT_LE(known.age->time, bound.age->time);
    ASSERT_LE(known.reduced_age->time, bound.reduced_age->time);
    ASSERT_EQ(bound.reaction.time, bound.age->time);
    expect_shares(bound, "bound of chain " + std::to_string(index));
    const bool one_job =
        std::ranges::all_of(drawn.stages, [](const Stage& s) { return s.activated || s.jobs.size() == 1; });
    if (one_job) {
      ASSERT_EQ(bound.reaction.time.ns, davare(drawn.stages)) << "chain " << index;
    }
    const auto sampled = std::ranges::count(drawn.stages, false, &Stage::activated);
    ASSERT_EQ(bound.exact, sampled == 1) << "chain " << index;
  }
}

// Two stages of one period: some phase comes within a unit of the bound.
TEST(EndToEnd, SomePhaseReachesTheBound) {
  for (const std::int64_t period : {5, 8, 13}) {
    std::int64_t largest = 0;
    for (std::int64_t phase = 0; phase < period; ++phase)
      largest = std::max(largest, end_to_end(let_chain({period, period}, {0, phase})).reaction.time.ns);
    const EndToEnd bound = end_to_end(of_any_phase(let_chain({period, period}, {0, 0})));
    EXPECT_EQ(bound.reaction.time.ns, 4 * period);
    EXPECT_EQ(largest, 4 * period - 1);
    EXPECT_FALSE(bound.exact);
  }
}

TEST(EndToEnd, TwoOriginsAddUp) {
  std::vector<Stage> stages = let_chain({10, 20, 10, 15}, {0, 0, 0, 0});
  stages[2].origin = stages[3].origin = 1;
  const EndToEnd found = end_to_end(stages);
  EXPECT_EQ(times_of(found), (FlowTimes{50 + 45, 40 + 45, 50 + 45, 50 + 30}));
  EXPECT_FALSE(found.exact);
}

TEST(EndToEnd, ActivatedFromTheBeginning) {
  const std::vector<Stage> all{activated_stage("a", ns(3), true), activated_stage("b", ns(4), true)};
  EndToEnd found = end_to_end(all);
  EXPECT_EQ(times_of(found), (FlowTimes{7, 7, -1, 7}));
  EXPECT_TRUE(found.exact);
  const std::vector<Stage> mixed{activated_stage("a", ns(3), true), let_stage("b", ns(10), ns(0), ns(10))};
  found = end_to_end(mixed);
  EXPECT_EQ(times_of(found), (FlowTimes{23, 23, -1, -1}));
  EXPECT_FALSE(found.exact);
}

// Periods of large primes have a long hyperperiod. It is cut into segments.
TEST(EndToEnd, LongHyperperiodsAreCut) {
  const std::vector<std::int64_t> periods{999983, 999979, 10, 20};
  const EndToEnd found = end_to_end(let_chain(periods, {0, 0, 0, 0}));
  EXPECT_FALSE(found.exact);
  EXPECT_EQ(found.reaction.time.ns, 2 * 999983 + 2 * 999979 + 50);
}

TEST(EndToEnd, BehindItsSender) {
  std::vector<Stage> stages{sampled_stage("a", ns(10), {}, ns(4)), sampled_stage("b", ns(30), {}, ns(9)),
                            sampled_stage("c", ns(20), {}, ns(15))};
  EXPECT_EQ(end_to_end(stages).reaction.time.ns, 10 + 4 + 30 + 9 + 20 + 15);
  stages[1].behind_sender = true;
  const EndToEnd found = end_to_end(stages);
  EXPECT_EQ(times_of(found),
            (FlowTimes{10 + 30 + 9 + 20 + 15, 30 + 9 + 20 + 15, 10 + 30 + 9 + 20 + 15, 10 + 30 + 9 + 15}));
  expect_shares(found, "behind");
}

}  // namespace
}  // namespace ttf::schedules::timing::chain
