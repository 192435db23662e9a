// Automotive task and message sets (WATERS 2015) against a simulator. No run exceeds a response. The critical instant
// reaches each exact one.
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "core/random.h"
#include "schedules/timing/response/can.h"
#include "schedules/timing/response/fixed_priority.h"
#include "schedules/timing/response/priorities.h"
#include "tests/schedules/timing/simulated_resource.h"
#include "tests/schedules/timing/waters.h"

namespace ttf::schedules::timing::response {
namespace {

constexpr std::int64_t kMs = 1'000'000;

// A repeating activity: a task or a message, by priority.
struct Repeating {
  std::int64_t period = 0, work = 0, jitter = 0;
};

// Arrivals before `until`, each from its own phase on. Jitter is drawn. Work is the worst case, or at least half of it.
std::vector<SimulatedJob> running_jobs(RandomStream& stream, const std::vector<Repeating>& set, std::int64_t until,
                                       bool shorter) {
  std::vector<SimulatedJob> jobs;
  for (std::size_t i = 0; i < set.size(); ++i)
    for (std::int64_t at = stream.integer(0, set[i].period - 1); at < until; at += set[i].period) {
      const std::int64_t work = shorter ? stream.integer((set[i].work + 1) / 2, set[i].work) : set[i].work;
      jobs.push_back({i, at, at + stream.integer(0, set[i].jitter), work});
    }
  return jobs;
}

// All come at once: the first ones with their jitter, the next ones without.
std::vector<SimulatedJob> critical_jobs(const std::vector<Repeating>& set, std::int64_t until) {
  std::vector<SimulatedJob> jobs;
  for (std::size_t i = 0; i < set.size(); ++i)
    for (std::int64_t at = -set[i].jitter; at < until; at += set[i].period)
      jobs.push_back({i, at, std::max<std::int64_t>(0, at), set[i].work});
  return jobs;
}

std::vector<TaskTimes> as_tasks(const std::vector<Repeating>& set) {
  std::vector<TaskTimes> tasks;
  for (const Repeating& one : set)
    tasks.push_back({.period = one.period,
                     .work = one.work,
                     .deadline = one.period,
                     .jitter = one.jitter,
                     .blocking = 0,
                     .offset = {}});
  return tasks;
}

// Ten runnables, rate monotonic. Their worst cases are scaled to a load of 0.4 to 0.99. Half of the sets have jitter.
std::vector<Repeating> drawn_tasks_of(RandomStream& stream) {
  const std::vector<WatersTask> drawn = draw_waters_tasks(stream, 1e9, 10);
  double load = 0.0;
  for (const WatersTask& one : drawn) load += static_cast<double>(one.worst) / static_cast<double>(one.period);
  const double scale = stream.uniform(0.4, 0.99) / load;
  const bool jitter = stream.integer(0, 1) == 1;
  std::vector<Repeating> set;
  for (const WatersTask& one : drawn)
    set.push_back({one.period,
                   std::max<std::int64_t>(1, static_cast<std::int64_t>(scale * static_cast<double>(one.worst))),
                   jitter ? stream.integer(0, one.period / 4) : 0});
  std::stable_sort(set.begin(), set.end(), [](const Repeating& a, const Repeating& b) { return a.period < b.period; });
  return set;
}

// Messages at 500 kbit/s up to a load of 0.95, shorter periods first.
std::vector<Repeating> drawn_messages_of(RandomStream& stream, std::int64_t bit) {
  const double most = stream.uniform(0.4, 0.95);
  std::vector<Repeating> set;
  for (double load = 0.0; set.size() < 40;) {
    const WatersMessage drawn = draw_waters_message(stream);
    const std::int64_t time = bit * can_frame_bits(CanIdentifier::k11Bits, drawn.data_bytes);
    load += static_cast<double>(time) / static_cast<double>(drawn.period);
    if (load > most) break;
    set.push_back({drawn.period, time, stream.integer(0, drawn.period / 4)});
  }
  std::stable_sort(set.begin(), set.end(), [](const Repeating& a, const Repeating& b) { return a.period < b.period; });
  return set;
}

std::int64_t horizon_of(const std::vector<Repeating>& set, const Response& response, std::size_t which) {
  return 2 * (response.longest + set[which].period);
}

void expect_none_exceeds(const std::vector<std::int64_t>& longest, const std::vector<Response>& responses) {
  for (std::size_t i = 0; i < responses.size(); ++i) {
    ASSERT_EQ(responses[i].quality, Quality::kExact);
    ASSERT_LE(longest[i], responses[i].longest) << i;
  }
}

void check_preemptive(RandomStream& stream) {
  const std::vector<Repeating> set = drawn_tasks_of(stream);
  const std::vector<Response> responses = preemptive(as_tasks(set));
  const auto running = running_jobs(stream, set, 200 * kMs, true);
  expect_none_exceeds(simulated_longest(running, set.size(), Preemption::kAlways), responses);
  std::int64_t until = 0;
  for (std::size_t i = 0; i < set.size(); ++i) until = std::max(until, horizon_of(set, responses[i], i));
  const auto critical = simulated_longest(critical_jobs(set, until), set.size(), Preemption::kAlways);
  for (std::size_t i = 0; i < set.size(); ++i) ASSERT_EQ(critical[i], responses[i].longest) << i;
}

// The critical instant of one task or message: the longest lower one has just begun.
void expect_reached(const std::vector<Repeating>& set, const std::vector<Response>& responses, std::size_t which,
                    std::int64_t just_begun) {
  std::int64_t begin = 0;
  for (std::size_t i = which + 1; i < set.size(); ++i) begin = std::max(begin, set[i].work - just_begun);
  const std::vector<Repeating> level(set.begin(), set.begin() + static_cast<std::ptrdiff_t>(which) + 1);
  const auto jobs = critical_jobs(level, horizon_of(set, responses[which], which));
  ASSERT_EQ(simulated_longest(jobs, level.size(), Preemption::kNever, begin)[which], responses[which].longest);
}

std::size_t one_of(RandomStream& stream, const std::vector<Repeating>& set) {
  return static_cast<std::size_t>(stream.integer(0, static_cast<std::int64_t>(set.size()) - 1));
}

void check_non_preemptive(RandomStream& stream) {
  const std::vector<Repeating> set = drawn_tasks_of(stream);
  const std::vector<Response> responses = non_preemptive(as_tasks(set));
  const auto running = running_jobs(stream, set, 200 * kMs, true);
  expect_none_exceeds(simulated_longest(running, set.size(), Preemption::kNever), responses);
  expect_reached(set, responses, one_of(stream, set), 1);
}

// Messages are queued at whole bits, as in the analysis.
void check_can(RandomStream& stream) {
  constexpr std::int64_t kBit = 2'000;
  std::vector<Repeating> set = drawn_messages_of(stream, kBit);
  if (set.empty()) return;
  std::vector<CanMessage> messages;
  for (Repeating& one : set) {
    one.jitter -= one.jitter % kBit;
    messages.push_back({.period = one.period, .transmission = one.work, .deadline = one.period, .jitter = one.jitter});
  }
  const std::vector<Response> responses = can_responses({.bit = kBit, .errors = {}}, messages);
  const auto running = running_jobs(stream, set, 200 * kMs, false);
  expect_none_exceeds(simulated_longest(running, set.size(), Preemption::kNever), responses);
  expect_reached(set, responses, one_of(stream, set), 0);
}

// The simulated hyperperiod is at most the bound. No run with its offsets exceeds it.
void check_offsets(RandomStream& stream) {
  std::vector<Repeating> set = drawn_tasks_of(stream);
  std::vector<TaskTimes> tasks = as_tasks(set);
  for (TaskTimes& one : tasks) one.jitter = 0;
  const std::vector<Response> any_phase = preemptive(tasks);
  std::vector<SimulatedJob> jobs;
  for (std::size_t i = 0; i < tasks.size(); ++i) {
    tasks[i].offset = stream.integer(0, tasks[i].period - 1);
    for (std::int64_t at = *tasks[i].offset; at < 300 * kMs; at += tasks[i].period)
      jobs.push_back({i, at, at, tasks[i].work});
  }
  const std::vector<Response> placed = preemptive(tasks);
  expect_none_exceeds(simulated_longest(jobs, tasks.size(), Preemption::kAlways), placed);
  for (std::size_t i = 0; i < tasks.size(); ++i) ASSERT_LE(placed[i].longest, any_phase[i].longest) << i;
}

void check_drawn_set(std::uint32_t set) {
  SCOPED_TRACE(set);
  RandomStream stream({.seed = 51, .index = set});
  switch (set % 4) {
    case 0: return check_preemptive(stream);
    case 1: return check_non_preemptive(stream);
    case 2: return check_can(stream);
    default: return check_offsets(stream);
  }
}

TEST(DrawnSets, TwoHundred) {
  for (std::uint32_t set = 0; set < 200 && !HasFatalFailure(); ++set) check_drawn_set(set);
}

TEST(DrawnSets, TenThousand) {
  for (std::uint32_t set = 0; set < 10'000 && !HasFatalFailure(); ++set) check_drawn_set(set);
}

}  // namespace
}  // namespace ttf::schedules::timing::response
