// Buses and slots of the CSV file, by hand, and jitters that have no end.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "schedules/timing/response/can_faults.h"
#include "schedules/timing/task_set/reader.h"
#include "schedules/timing/task_set/verdict.h"

namespace ttf::schedules::timing::task_set {
namespace {

using response::Quality;
using response::Response;
using testing::HasSubstr;

struct OnBuses {
  TaskSet set;
  Verdict verdict;

  explicit OnBuses(const std::string& text) : set(parse_task_set(text, "set.csv")), verdict(verdict_on(set)) {}
  Response response(std::size_t task) const { return verdict.responses.tasks[task].response; }
  std::string text() const { return verdict_text(set, verdict); }
};

// Work of 1.5 ms takes three slots of 0.5 ms: 1.5 + 3 (2 - 0.5) = 6 ms. The other task does not matter.
TEST(TaskSetBuses, Tdma) {
  const OnBuses judged(
      "processor,p,tdma,,2 ms\ntask,a,p,10 ms,,,,1500 us,,,,500 us\ntask,b,p,5 ms,,,,9 ms,,,,500 us\n"
      "processor,q,preemptive\ntask,c,q,20 ms,,,1 ms,3 ms\ntask,d,p,,,,,400 us,,,event,500 us\n"
      "chain,a alone,a\nchain,cd,c > d\n");
  EXPECT_EQ(judged.response(0), (Response{Quality::kExact, 6'000'000}));
  EXPECT_FALSE(judged.response(1).bounded()) << "9 ms of work every 5 ms do not fit a quarter of the time";
  // c ends 1 ms to 3 ms behind its release: a jitter of 2 ms, and d takes 0.4 + 1.5 ms.
  EXPECT_EQ(judged.response(3), (Response{Quality::kBound, 2'000'000 + 400'000 + 1'500'000}));
  EXPECT_FALSE(judged.verdict.chains[0].times->exact) << "its slot may come at once";
  EXPECT_EQ(judged.verdict.chains[0].times->age->time, Duration::milliseconds(16));
  EXPECT_THAT(judged.text(), HasSubstr("processor p (tdma), load 197.0 %\n  each in its slot [ms]"));
}

// 30 minislots of slot 1 in every second cycle take the turn of slot 2 away: 1 + 30 > 30, the latest one for 11.
TEST(TaskSetBuses, DynamicSegment) {
  const std::string bus = "bus,d,dynamic,,,1 ms,40,10 us,start\n", slot2 = "message,b,d,8 ms,,,,11,,2,,,,30\n";
  const std::string sporadic = "message,a,d,2 ms,,,,30,,1,event\n", periodic = "message,a,d,2 ms,,,,30,,1\n";
  EXPECT_EQ(OnBuses(bus + slot2).response(0), (Response{Quality::kExact, 1'120'000}));
  EXPECT_EQ(OnBuses(bus + sporadic + slot2).response(1), (Response{Quality::kExact, 2'120'000}));
  EXPECT_EQ(OnBuses(bus + periodic + slot2).response(1), (Response{Quality::kBound, 2'120'000}));
  EXPECT_EQ(OnBuses(bus + slot2 + periodic).response(0), (Response{Quality::kBound, 2'120'000}))
      << "slots have numbers";
  // In other cycles no frame is before it, but it has every second cycle only.
  const OnBuses apart(bus + "message,a,d,2 ms,,,,30,,1,,,0/2\nmessage,b,d,8 ms,,,,11,,2,,,1/2,30\n");
  EXPECT_EQ(apart.response(1).longest, 2'120'000);
  EXPECT_DOUBLE_EQ(apart.verdict.responses.resources[0].load, (300.0 / 2'000 + 110.0 / 8'000) * 1'000 / 400);
}

// 8 bytes at 125 kbit/s are 1080 us, the bit is 8 us. One error within 20 ms costs 31 bits and one frame of 1080 us.
TEST(TaskSetBuses, CanWithErrorsApart) {
  const std::string messages = "message,a,can,10 ms,,,,8,,1\nmessage,b,can,20 ms,,,,8,,2\n";
  EXPECT_EQ(OnBuses("bus,can,can,125000\n" + messages).response(1), (Response{Quality::kExact, 2'160'000}));
  const OnBuses judged("bus,can,can,125000,,,,,,20 ms\n" + messages);
  EXPECT_EQ(judged.response(0), (Response{Quality::kBound, 2 * 1'080'000 + 31 * 8'000 + 1'080'000}));
  EXPECT_EQ(judged.response(1), (Response{Quality::kBound, 2 * 1'080'000 + 31 * 8'000 + 1'080'000}));
  EXPECT_THAT(judged.text(), HasSubstr(", errors 20 ms apart or more, priorities as given"));
  EXPECT_FALSE(OnBuses("bus,can,can,125000,,,,,,1 ms\n" + messages).verdict.holds());
}

TEST(TaskSetBuses, CanWithErrorsAtRandom) {
  const OnBuses judged(
      "bus,can,can,125000,,,,,,30/s\nmessage,a,can,10 ms,,1 ms,,8,,1\nmessage,b,can,20 ms,,,,8,8 ms,2\nchain,a,a\n");
  EXPECT_EQ(judged.response(1), (Response{Quality::kExact, 2'160'000}));
  const std::vector<response::CanMessage> messages{
      {.period = 10'000'000, .transmission = 1'080'000, .deadline = 10'000'000, .jitter = 1'000'000},
      {.period = 20'000'000, .transmission = 1'080'000, .deadline = 8'000'000, .jitter = 0}};
  const double a = response::responses_with_faults(8'000, 30e-9, {}, messages[0], 1'080'000).miss_probability;
  const double b =
      response::responses_with_faults(8'000, 30e-9, std::span(messages).first(1), messages[1], 0).miss_probability;
  EXPECT_NEAR(judged.verdict.responses.tasks[0].miss_probability.value_or(1), a, 1e-12);
  EXPECT_NEAR(judged.verdict.responses.tasks[1].miss_probability.value_or(1), b, 1e-12);
  EXPECT_GT(b, 1e-6);
  EXPECT_LT(b, 1e-2);
  EXPECT_THAT(judged.text(), HasSubstr("late at most "));
  EXPECT_THAT(judged.text(), HasSubstr("chain a: a (bound without errors)"));
}

// `a` activates `b` of a higher priority on its own processor. The jitter of b is a's response, which b delays: J_b = ...
// + U_b / (1 - U_b) J_b. It has a solution if, and only if, U_b is below one half.
std::string activated_by_lower(std::int64_t b_us) {
  return "processor,p,preemptive\ntask,a,p,100 ms,,,,1 ms,1000 s,2\ntask,b,p,,,,," + std::to_string(b_us) +
         " us,1000 s,1,event\ntask,c,p,1 s,,,,1 ms,1000 s,3\ntask,d,p,1 s,,,,1 ms,1000 s,0\nchain,ab,a > b\n";
}

TEST(TaskSetGrowth, HalfTheLoadOfAnActivatedTaskIsTheLimit) {
  const OnBuses below(activated_by_lower(49'000));
  EXPECT_TRUE(below.verdict.holds()) << below.text();
  EXPECT_TRUE(below.response(1).bounded());
  for (const std::int64_t work : {50'000, 50'001, 60'000, 95'000}) {
    const OnBuses above(activated_by_lower(work));
    EXPECT_FALSE(above.response(1).bounded()) << work;
    EXPECT_FALSE(above.response(2).bounded()) << "it has a lower priority than b";
    EXPECT_EQ(above.response(3), (Response{Quality::kExact, 1'000'000})) << "nothing delays d";
    EXPECT_LT(above.verdict.responses.rounds, 10) << work;
  }
}

// On another processor of higher load the jitter does not come back.
TEST(TaskSetGrowth, ChainsWithoutACycleHaveAnEnd) {
  const OnBuses judged(
      "processor,p,preemptive\nprocessor,q,preemptive\ntask,a,p,10 ms,,,,1 ms,1 s,2\ntask,b,q,,,,,8 ms,1 s,1,event\n"
      "task,c,p,,,,,4 ms,1 s,3,event\nchain,abc,a > b > c\n");
  EXPECT_TRUE(judged.verdict.holds()) << judged.text();
  EXPECT_LT(judged.verdict.responses.rounds, 10);
}

}  // namespace
}  // namespace ttf::schedules::timing::task_set
