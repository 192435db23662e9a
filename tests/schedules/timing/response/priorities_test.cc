// Assignments of priorities against all orders of small sets.
#include "schedules/timing/response/priorities.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <vector>

#include "core/random.h"
#include "schedules/timing/response/can.h"

namespace ttf::schedules::timing::response {
namespace {

std::vector<TaskTimes> drawn_tasks(RandomStream& stream, std::size_t count, double longest_deadline) {
  std::vector<TaskTimes> tasks;
  for (std::size_t i = 0; i < count; ++i) {
    const std::int64_t period = stream.integer(6, 30), work = stream.integer(1, 5);
    const auto most = static_cast<std::int64_t>(longest_deadline * static_cast<double>(period));
    tasks.push_back({.period = period,
                     .work = work,
                     .deadline = stream.integer(std::min(most, work + 4), most),
                     .jitter = stream.integer(0, 3),
                     .blocking = 0,
                     .offset = {}});
  }
  return tasks;
}

// Calls `keeps` with every order, and returns whether one of them is right.
template <class T, class Keeps> bool any_order(const std::vector<T>& list, Keeps keeps) {
  PriorityOrder order(list.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  do {
    if (keeps(in_order(list, order))) return true;
  } while (std::next_permutation(order.begin(), order.end()));
  return false;
}

template <class T> bool all_keep(const std::vector<Response>& responses, const std::vector<T>& list) {
  for (std::size_t i = 0; i < list.size(); ++i)
    if (!responses[i].keeps(list[i].deadline)) return false;
  return true;
}

struct Tally {
  int found = 0, none = 0;
  void add(bool one) { ++(one ? found : none); }
};

// An order is found just where there is one, and it meets all deadlines.
template <class T, class Keeps>
void expect_optimal(const std::vector<T>& list, const std::optional<PriorityOrder>& order, Keeps keeps, Tally& tally) {
  EXPECT_EQ(order.has_value(), any_order(list, keeps));
  if (order) {
    EXPECT_TRUE(keeps(in_order(list, *order)));
  }
  tally.add(order.has_value());
}

TEST(Audsley, IsOptimalForPreemptiveTasks) {
  RandomStream stream({.seed = 31});
  Tally tally;
  for (int set = 0; set < 400; ++set) {
    const std::vector<TaskTimes> tasks = drawn_tasks(stream, 4, 1.8);
    expect_optimal(
        tasks, audsley_preemptive(tasks),
        [](const std::vector<TaskTimes>& ordered) { return all_keep(preemptive(ordered), ordered); }, tally);
  }
  EXPECT_GT(tally.found, 50);
  EXPECT_GT(tally.none, 50);
}

TEST(Audsley, IsOptimalForNonPreemptiveTasks) {
  RandomStream stream({.seed = 32});
  Tally tally;
  for (int set = 0; set < 400; ++set) {
    const std::vector<TaskTimes> tasks = drawn_tasks(stream, 4, 1.8);
    expect_optimal(
        tasks, audsley_non_preemptive(tasks),
        [](const std::vector<TaskTimes>& ordered) { return all_keep(non_preemptive(ordered), ordered); }, tally);
  }
  EXPECT_GT(tally.found, 50);
  EXPECT_GT(tally.none, 50);
}

TEST(Audsley, IsOptimalForCanWhereDeadlineMonotonicIsNot) {
  RandomStream stream({.seed = 33});
  const CanBus bus{.bit = 1, .errors = {}};
  Tally tally, deadline_order;
  for (int set = 0; set < 400; ++set) {
    std::vector<CanMessage> messages;
    for (const TaskTimes& one : drawn_tasks(stream, 4, 1.0))
      messages.push_back({one.period, one.work, one.deadline, one.jitter});
    std::stable_sort(messages.begin(), messages.end(),
                     [](const CanMessage& a, const CanMessage& b) { return a.deadline < b.deadline; });
    const auto keeps = [&](const std::vector<CanMessage>& ordered) {
      return all_keep(can_responses(bus, ordered), ordered);
    };
    const auto order = audsley_can(bus, messages);
    expect_optimal(messages, order, keeps, tally);
    deadline_order.add(keeps(messages));
  }
  EXPECT_GT(tally.none, 50);
  EXPECT_GT(deadline_order.found, 20);
  EXPECT_GT(tally.found, deadline_order.found) << "some sets need another order than their deadlines'";
}

// Leung and Whitehead: no order does better for deadlines up to the period, without jitter.
TEST(DeadlineMonotonic, IsOptimalForShortDeadlines) {
  RandomStream stream({.seed = 34});
  Tally tally;
  for (int set = 0; set < 400; ++set) {
    std::vector<TaskTimes> tasks = drawn_tasks(stream, 4, 1.0);
    for (TaskTimes& one : tasks) one.jitter = 0, one.deadline = std::min(one.deadline, one.period);
    const auto keeps = [](const std::vector<TaskTimes>& ordered) { return all_keep(preemptive(ordered), ordered); };
    const bool found = keeps(in_order(tasks, deadline_monotonic(tasks)));
    EXPECT_EQ(found, any_order(tasks, keeps));
    tally.add(found);
  }
  EXPECT_GT(tally.found, 50);
  EXPECT_GT(tally.none, 50);
}

TEST(PriorityOrders, KeepTheListsOrderAmongEquals) {
  std::vector<TaskTimes> tasks(3);
  for (TaskTimes& one : tasks) one = {.period = 5, .work = 1, .deadline = 9, .jitter = 0, .blocking = 0, .offset = {}};
  tasks[1].period = 4;
  tasks[2].deadline = 3;
  EXPECT_EQ(rate_monotonic(tasks), (PriorityOrder{1, 0, 2}));
  EXPECT_EQ(deadline_monotonic(tasks), (PriorityOrder{2, 0, 1}));
  EXPECT_EQ(audsley_preemptive(tasks), (PriorityOrder{0, 1, 2})) << "everything fits everywhere";
}

// There are at most n (n + 1) / 2 questions.
TEST(Audsley, AsksLittle) {
  int questions = 0;
  const auto fits = [&](std::size_t task, std::span<const std::size_t> higher, std::span<const std::size_t> lower) {
    ++questions;
    EXPECT_EQ(higher.size() + lower.size(), 19U);
    EXPECT_TRUE(std::is_sorted(higher.begin(), higher.end()) && std::is_sorted(lower.begin(), lower.end()));
    return lower.size() == 19 - task || (higher.empty() && task == 0);
  };
  EXPECT_EQ(audsley(20, fits)->front(), 0U);
  EXPECT_LE(questions, 20 * 21 / 2);
  EXPECT_EQ(audsley(20, [](std::size_t, auto, auto) { return false; }), std::nullopt);
  EXPECT_EQ(audsley(0, [](std::size_t, auto, auto) { return false; }), PriorityOrder{});
}

}  // namespace
}  // namespace ttf::schedules::timing::response
