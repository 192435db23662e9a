#include "schedules/synthesis/generator.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/check.h"
#include "core/random.h"

namespace ttf::schedules::synthesis {
namespace {

constexpr std::int64_t kDistinctPeriods = 7;
// Tasks beside a node's shortest period are at most so much of it long, so that they fit between its tasks.
constexpr double kLongest = 0.15, kMostBeside = 0.5;

class Generator {
 public:
  explicit Generator(const Shape& shape)
      : shape_(shape), draws_({.seed = shape.seed, .purpose = Purpose::kSynthesis, .index = 1}) {
    TTF_CHECK(shape.nodes >= 3 && shape.tasks >= shape.nodes && shape.messages >= 4, "{} nodes, {} tasks, {} messages",
              shape.nodes, shape.tasks, shape.messages);
    TTF_CHECK(shape.load >= 0.2 && shape.load <= 0.9, "load {}", shape.load);
  }

  Problem made() {
    for (int node = 0; node < shape_.nodes; ++node) problem_.resources.push_back({fmt::format("node {}", node + 1)});
    problem_.resources.push_back({"static segment"});
    make_tasks();
    make_chains();
    while (static_cast<int>(senders_.size()) < shape_.messages) senders_.push_back(drawn_task());
    make_messages();
    return problem_;
  }

 private:
  std::size_t drawn_task() { return static_cast<std::size_t>(draws_.integer(0, shape_.tasks - 1)); }
  std::size_t node_of(std::size_t task) const { return *problem_.activities[task].resource; }
  Ticks period_of(std::size_t task) const { return problem_.activities[task].period; }

  void make_tasks() {
    for (int task = 0; task < shape_.tasks; ++task) {
      const Ticks period = shape_.cycle << draws_.integer(0, kDistinctPeriods - 1);
      const auto node = static_cast<std::size_t>(task % shape_.nodes);
      problem_.activities.push_back({fmt::format("task {}", task + 1), 0, node, period, 0, {0, period - 1}, {}, {}});
    }
    for (std::size_t node = 0; node < static_cast<std::size_t>(shape_.nodes); ++node) load(node);
  }

  // Tasks of longer periods are short beside the node's shortest period, whose tasks share the rest of the load.
  void load(std::size_t node) {
    std::vector<Activity*> all;
    for (Activity& task : problem_.activities)
      if (task.resource == node) all.push_back(&task);
    const Ticks shortest = (*std::ranges::min_element(all, {}, &Activity::period))->period;
    double beside = 0, shares = 0;
    std::vector<double> parts;
    for (const Activity* task : all) {
      parts.push_back(draws_.uniform(0.3, 1.0));
      if (task->period == shortest)
        shares += parts.back();
      else
        beside += parts.back() * kLongest * static_cast<double>(shortest) / static_cast<double>(task->period);
    }
    const double scale = std::min(1.0, kMostBeside * shape_.load / std::max(beside, 1e-9));
    const double left = shape_.load - beside * scale;
    for (std::size_t at = 0; at < all.size(); ++at) {
      const double share = all[at]->period == shortest ? parts[at] / shares * left : parts[at] * kLongest * scale;
      all[at]->duration = std::max<Ticks>(1, std::llround(share * static_cast<double>(shortest)));
    }
  }

  // A task on another node than those of `taken`, of a period if there is one.
  std::size_t elsewhere(const std::vector<std::size_t>& taken, Ticks period) {
    std::vector<std::size_t> of_period, any;
    for (std::size_t task = 0; task < static_cast<std::size_t>(shape_.tasks); ++task) {
      if (std::ranges::any_of(taken, [&](std::size_t other) { return node_of(other) == node_of(task); })) continue;
      any.push_back(task);
      if (period_of(task) == period) of_period.push_back(task);
    }
    const std::vector<std::size_t>& from = of_period.empty() ? any : of_period;
    return from[static_cast<std::size_t>(draws_.integer(0, static_cast<std::int64_t>(from.size()) - 1))];
  }

  void make_chains() {
    const int count = static_cast<int>(shape_.in_chains * shape_.messages / 2);
    for (int chain = 0; chain < count; ++chain) {
      std::vector<std::size_t> tasks = {drawn_task()};
      const double kind = draws_.uniform();
      while (tasks.size() < 3) {
        const bool other = kind > 0.9 || (kind > 0.7 && tasks.size() == 2);
        tasks.push_back(elsewhere(tasks, period_of(other ? drawn_task() : tasks.back())));
      }
      const std::size_t message = static_cast<std::size_t>(shape_.tasks) + senders_.size();
      problem_.chains.push_back(
          {fmt::format("chain {}", chain + 1), {tasks[0], message, tasks[1], message + 1, tasks[2]}, {}, {}, true, 0});
      senders_.push_back(tasks[0]);
      senders_.push_back(tasks[1]);
    }
  }

  void make_messages() {
    double slots_used = 0;
    for (const std::size_t sender : senders_)
      slots_used += static_cast<double>(shape_.cycle) / static_cast<double>(period_of(sender));
    const auto slots = static_cast<Ticks>(std::ceil(slots_used / shape_.load));
    const Ticks length = shape_.cycle * 4 / 5 / slots;
    TTF_CHECK(length > 0, "{} slots in a cycle of {} ticks", slots, shape_.cycle);
    const Grid grid{shape_.cycle, 0, (slots - 1) * length, length};
    for (std::size_t message = 0; message < senders_.size(); ++message) {
      const Ticks period = period_of(senders_[message]);
      problem_.precedences.push_back({senders_[message], problem_.activities.size(), 0, std::nullopt, 0});
      problem_.activities.push_back({fmt::format("message {}", message + 1),
                                     0,
                                     problem_.resources.size() - 1,
                                     period,
                                     length,
                                     {0, 2 * period - 1},
                                     grid,
                                     {}});
    }
  }

  Shape shape_;
  RandomStream draws_;
  Problem problem_;
  std::vector<std::size_t> senders_;  // by message
};

}  // namespace

Problem generated(const Shape& shape) { return Generator(shape).made(); }

double load_of(const Problem& problem, std::size_t resource) {
  double busy = 0, room = 1;
  for (const Activity& activity : problem.activities) {
    if (activity.resource != resource) continue;
    const Grid& grid = activity.grid;
    if (grid.period > 1)
      room = static_cast<double>((grid.last - grid.first + grid.step)) / static_cast<double>(grid.period);
    busy += static_cast<double>(activity.duration) / static_cast<double>(activity.period);
  }
  return busy / room;
}

}  // namespace ttf::schedules::synthesis
