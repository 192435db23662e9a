// Verdicts on task sets. Responses are published ones, or computed by hand.
#include "schedules/timing/task_set/verdict.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "core/random.h"
#include "schedules/timing/task_set/reader.h"
#include "schedules/timing/task_set/table.h"

namespace ttf::schedules::timing::task_set {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

struct Judged {
  TaskSet set;
  Verdict verdict;

  explicit Judged(const std::string& text) : set(parse_task_set(text, "set.csv")), verdict(verdict_on(set)) {}
  std::int64_t response_us(std::size_t task) const { return verdict.responses.tasks[task].response.longest / 1000; }
};

// R. Davis, A. Burns, R. Bril, J. Lukkien, Real-Time Systems 35, 2007: 125 bits of 7 bytes at 125 kbit/s.
TEST(TaskSetVerdict, CounterExampleOfCan) {
  const Judged judged(
      "bus,can,can,125000\n"
      "message,A,can,2.5 ms,,,,7,2.5 ms,1\nmessage,B,can,3.5 ms,,,,7,3.25 ms,2\n"
      "message,C,can,3.5 ms,,,,7,3.25 ms,3\nchain,of C,C\n");
  EXPECT_EQ(judged.response_us(0), 2000);
  EXPECT_EQ(judged.response_us(1), 3000);
  EXPECT_EQ(judged.response_us(2), 3500);
  EXPECT_THAT(judged.verdict.misses, ElementsAre("C: a response of 3500 us misses its deadline of 3250 us"));
  EXPECT_EQ(judged.verdict.chains[0].times->reaction.time, Duration::milliseconds(7));
  EXPECT_FALSE(judged.verdict.chains[0].times->exact);
}

// (C, T) = (1, 4) (1, 5) (3, 9) (3, 18): R = 1, 2, 7, 18
TEST(TaskSetVerdict, AssignedPriorities) {
  const Judged judged(
      "processor,p,preemptive\ntask,d,p,18 ms,,,,3 ms\ntask,c,p,9 ms,,,,3 ms\ntask,b,p,5 ms,,,,1 ms\ntask,a,p,4 "
      "ms,,,,1 ms\n");
  EXPECT_THAT(judged.verdict.responses.resources[0].by_priority, ElementsAre(3, 2, 1, 0));
  EXPECT_EQ(judged.verdict.responses.resources[0].assignment, Assignment::kDeadlineMonotonic);
  EXPECT_THAT((std::vector{judged.response_us(3), judged.response_us(2), judged.response_us(1), judged.response_us(0)}),
              ElementsAre(1000, 2000, 7000, 18000));
  EXPECT_TRUE(judged.verdict.holds());
}

// Jitter takes the slack. Deadline monotonic fails, and Audsley's algorithm exchanges the two.
TEST(TaskSetVerdict, AudsleysAlgorithm) {
  const Judged judged("processor,p,preemptive\ntask,a,p,20 ms,,,,3 ms,8 ms\ntask,b,p,20 ms,,6 ms,,3 ms,9 ms\n");
  EXPECT_EQ(judged.verdict.responses.resources[0].assignment, Assignment::kAudsley);
  EXPECT_THAT(judged.verdict.responses.resources[0].by_priority, ElementsAre(1, 0));
  EXPECT_TRUE(judged.verdict.holds()) << verdict_text(judged.set, judged.verdict);
  const Judged none("processor,p,preemptive\ntask,a,p,20 ms,,,,3 ms,5 ms\ntask,b,p,20 ms,,6 ms,,3 ms,9 ms\n");
  EXPECT_EQ(none.verdict.responses.resources[0].assignment, Assignment::kNone);
  EXPECT_EQ(none.verdict.misses.size(), 1U);
}

// Task a activates b on another processor. So b's jitter is R_a - best_a = 5 - 2. Task c sees it.
TEST(TaskSetVerdict, JittersOfActivations) {
  const Judged judged(
      "processor,p,preemptive\nprocessor,q,preemptive\n"
      "task,x,p,10 ms,,,1 ms,1 ms,,1\ntask,a,p,20 ms,,,2 ms,4 ms,,2\n"
      "task,b,q,,,,1 ms,3 ms,15 ms,1,event\ntask,c,q,19 ms,,,1 ms,2 ms,,2\n"
      "chain,ab,a > b,60 ms\n");
  const std::vector<TaskTiming>& tasks = judged.verdict.responses.tasks;
  EXPECT_EQ(tasks[2].jitter, Duration::milliseconds(3));
  EXPECT_EQ(tasks[2].response.longest, Duration::milliseconds(6).ns);
  EXPECT_EQ(tasks[2].longest, Duration::milliseconds(8));  // 2 + 6 = 5 + 3
  EXPECT_EQ(tasks[3].response.longest, Duration::milliseconds(5).ns);
  EXPECT_EQ(tasks[2].response.quality, response::Quality::kBound);
  const chain::EndToEnd& ends = *judged.verdict.chains[0].times;
  EXPECT_EQ(ends.reaction.time, Duration::milliseconds(20 + 5 + 3));
  EXPECT_EQ(ends.reduced_age->time, Duration::milliseconds(5 + 3));
}

// m2 comes 5 ms behind m1, so it never waits for it: 0.54 ms is no case.
TEST(TaskSetVerdict, OffsetsOnACanMakeBounds) {
  const auto response = [](const std::string& first, const std::string& second) {
    return Judged("bus,can,can,500000\nmessage,m1,can,10 ms," + first + ",,,8\nmessage,m2,can,10 ms," + second +
                  ",,,8\n")
        .verdict.responses.tasks[1]
        .response;
  };
  EXPECT_EQ(response("0 ms", "5 ms"), (response::Response{response::Quality::kBound, 540'000}));
  EXPECT_EQ(response("", ""), (response::Response{response::Quality::kExact, 540'000}));
  EXPECT_EQ(response("", "5 ms"), (response::Response{response::Quality::kExact, 540'000}));
}

// Task b begins as a ends and has ended before a comes again, so it never blocks a. Task d may.
TEST(TaskSetVerdict, BlockingByAnActivatedTaskIsABound) {
  const std::string text =
      "processor,p,non_preemptive\ntask,a,p,10 ms,,,1 ms,1 ms,,1\ntask,b,p,,,,4 ms,4 ms,,2,event\nchain,ab,a > b\n";
  const response::Response blocked = Judged(text).verdict.responses.tasks[0].response;
  EXPECT_EQ(blocked, (response::Response{response::Quality::kBound, 5'000'000 - 1}));
  const response::Response same = Judged(text + "task,d,p,40 ms,,,,4 ms,,3\n").verdict.responses.tasks[0].response;
  EXPECT_EQ(same, (response::Response{response::Quality::kExact, 5'000'000 - 1}));
}

// Hyperperiods and responses of days.
TEST(TaskSetVerdict, DaysAreTooLongForChains) {
  const Judged sampled(
      "processor,p,preemptive\ntask,a,p,500 s,0 s,,,1 s\ntask,b,p,499.9 s,0 s,,,1 s\nchain,ab,a > b\n");
  EXPECT_TRUE(sampled.verdict.holds());
  EXPECT_FALSE(sampled.verdict.chains[0].times->exact);
  const std::string text =
      "processor,p,preemptive\ntask,h,p,1000 s,,,,500 s,,1\ntask,i,p,998.9 s,,,,499449999001 ns,,2\n"
      "task,low,p,1000 s,,,,900 ns,,3,COMMUNICATION\nchain,c,low\n";
  for (const std::string communication : {"implicit", "event"}) {
    const Judged late(std::string(text).replace(text.find("COMMUNICATION"), 13, communication));
    ASSERT_TRUE(late.verdict.responses.tasks[2].bounded());
    EXPECT_EQ(late.verdict.chains[0].why_none, "its responses sum up to days");
    EXPECT_THAT(verdict_text(late.set, late.verdict), HasSubstr(" 1000000.000 "));
  }
}

TEST(TaskSetVerdict, ATaskAloneIsExact) {
  for (const std::string offset : {"", "3 ms"}) {
    const Judged alone("processor,p,preemptive\ntask,a,p,10 ms," + offset + ",,1 ms,2 ms\nchain,c,a\n");
    EXPECT_TRUE(alone.verdict.chains[0].times->exact);
    EXPECT_EQ(alone.verdict.chains[0].times->age->time, Duration::milliseconds(12));
  }
}

TEST(TaskSetVerdict, LogicalExecutionTime) {
  const std::string tasks =
      "processor,p,preemptive\ntask,a,p,10 ms,0 ms,,,2 ms,,,let\ntask,b,p,20 ms,0 ms,,,WORK,,,let\nchain,ab,a > "
      "b,AGE\n";
  const auto with = [&](const std::string& work, const std::string& age) {
    std::string text = tasks;
    text.replace(text.find("WORK"), 4, work);
    return text.replace(text.find("AGE"), 3, age);
  };
  const Judged held(with("9 ms", "50 ms"));
  EXPECT_TRUE(held.verdict.holds());
  EXPECT_TRUE(held.verdict.chains[0].times->exact);
  EXPECT_EQ(held.verdict.chains[0].times->age->time, Duration::milliseconds(50));
  EXPECT_THAT(Judged(with("9 ms", "49 ms")).verdict.misses, ElementsAre("ab: data may be 50 ms old, more than 49 ms"));
  EXPECT_THAT(Judged(with("17 ms", "50 ms")).verdict.misses,
              ElementsAre("b: no bound found for its response", "ab: no times: no bound found for the response of b"));
}

TEST(TaskSetVerdict, EventsFromOutsideHaveNoLargestAge) {
  const Judged judged(
      "processor,p,preemptive\ntask,a,p,10 ms,,,1 ms,1 ms,,,event\ntask,b,p,,,,1 ms,1 ms,,,event\nchain,ab,a > b,9 "
      "ms\n");
  EXPECT_THAT(judged.verdict.misses,
              ElementsAre("ab: data have no largest age, as events begin it; the limit is 9 ms"));
  EXPECT_THAT(verdict_text(judged.set, judged.verdict), HasSubstr("none"));
}

// Clocks that differ make phases unknown. The chain has a bound then.
TEST(TaskSetVerdict, ClocksOfResources) {
  const auto text = [](const std::string& clock) {
    return "processor,p,table,one\nprocessor,q,table," + clock +
           "\ntask,a,p,10 ms,0 ms,,1 ms,1 ms\ntask,b,q,10 ms,1 ms,,1 ms,1 ms\nchain,ab,a > b\n";
  };
  const chain::EndToEnd same = *Judged(text("one")).verdict.chains[0].times;
  EXPECT_TRUE(same.exact);
  EXPECT_EQ(same.reaction.time, Duration::milliseconds(12));
  const chain::EndToEnd other = *Judged(text("two")).verdict.chains[0].times;
  EXPECT_FALSE(other.exact);
  EXPECT_EQ(other.reaction.time, Duration::milliseconds(22));
}

TEST(TaskSetVerdict, TablesOverlap) {
  const std::string text =
      "processor,p,table\ntask,a,p,10 ms,0 ms,,,2 ms\ntask,b,p,15 ms,OFFSET,,,2 ms\nchain,ab,a > b\n";
  const auto at = [&](const std::string& offset) {
    return Judged(std::string(text).replace(text.find("OFFSET"), 6, offset)).verdict;
  };
  EXPECT_TRUE(at("2 ms").holds());
  EXPECT_TRUE(at("8 ms").holds());
  EXPECT_THAT(at("9 ms").misses, ElementsAre("p: a and b overlap", "ab: no times: jobs overlap on p"));
}

// A tick has several users if, and only if, the closed form says so.
TEST(TaskSetVerdict, OverlapsOfDrawnTables) {
  RandomStream stream({.seed = 10, .purpose = Purpose::kTest});
  std::size_t overlaps = 0;
  for (int draw = 0; draw < 2000; ++draw) {
    std::vector<TableEntry> table;
    constexpr std::int64_t kPeriods[] = {4, 6, 8, 12};
    for (std::int64_t entry = stream.integer(1, 3); entry > 0; --entry)
      table.push_back({.period = Duration{kPeriods[stream.integer(0, 3)]},
                       .offset = Duration{stream.integer(0, 11)},
                       .worst = Duration{stream.integer(1, 5)}});
    std::vector<int> users(200);
    for (const TableEntry& entry : table)
      for (std::int64_t start = entry.offset.ns; start < 100; start += entry.period.ns)
        for (std::int64_t tick = start; tick < start + entry.worst.ns; ++tick) ++users[static_cast<std::size_t>(tick)];
    const bool shared = std::ranges::any_of(users, [](int count) { return count > 1; });
    ASSERT_EQ(overlap_in(table).has_value(), shared) << "draw " << draw;
    overlaps += shared ? 1 : 0;
  }
  EXPECT_GT(overlaps, 500U);
  EXPECT_LT(overlaps, 1800U);
}

}  // namespace
}  // namespace ttf::schedules::timing::task_set
