#include "schedules/analysis/responses.h"

#include <algorithm>
#include <utility>

#include "core/int128.h"
#include "schedules/analysis/sensor_loop.h"
#include "schedules/model/round.h"

namespace ttf::schedules::analysis {
namespace {

constexpr std::int64_t kLongest_ns = 20'000'000'000;  // twice the longest deadline a file can ask for
constexpr int kMostRounds = 10'000;

// How a sensor that waits for the task's end activates it.
struct Following {
  std::int64_t best = 0, worst = 0;  // execution
  std::int64_t pause = 0;            // from its end to the next activation at the least
  std::int64_t round() const { return best + pause; }
  // The longest executions of activations before the last in a closed window.
  std::int64_t before_last(std::int64_t window) const {
    return window < round() ? 0 : static_cast<std::int64_t>(static_cast<Int128>(window) * worst / (worst + pause));
  }
};

// This much work more in windows from this length on.
struct Load {
  std::int64_t window = 0;
  std::int64_t work = 0;
};

class NodeTasks {
 public:
  NodeTasks(const model::Cluster& cluster, NodeId id, WritersOfLists writers)
      : cluster_(cluster), node_(cluster.node(id)) {
    const std::size_t count = node_.tasks.size();
    before_.resize(count);
    ahead_.resize(count);
    for (std::size_t t = 0; t < count; ++t)
      if (node_.tasks[t].activation.kind == model::ActivationKind::kCompletion)
        for (std::size_t other = 0; other < count; ++other)
          if (node_.tasks[other].name == node_.tasks[t].activation.after) before_[t] = other;
    whole_.resize(count);
    bounds_.resize(count);
    following_.resize(count);
    for (std::size_t t = 0; t < count; ++t) {
      const model::Task& task = node_.tasks[t];
      whole_[root(t)] += task.worst_case.ns;
      if (before_[t] || by_time(t)) continue;
      if (const auto loop = loop_through(cluster_, id, task))
        following_[t] = Following{shortest_execution(task).ns, task.worst_case.ns,
                                  std::max<std::int64_t>(1, shortest_return(cluster_, *loop).ns)};
      else
        bounds_[t] = activation_bounds(cluster_, task, writers);
    }
    round_ = time_of(cluster.flexray, model::kCycles, Macroticks{0}).ns;
    for (std::size_t t = 0; t < count; ++t)
      if (by_time(t))
        for (std::int64_t cycle = node_.tasks[t].activation.at.base_cycle; cycle < model::kCycles;
             cycle += node_.tasks[t].activation.at.repetition)
          instants_.emplace_back(time_of(cluster.flexray, cycle, node_.tasks[t].activation.at.offset).ns, t);
    std::sort(instants_.begin(), instants_.end());
  }

  std::optional<std::vector<TaskResponse>> responses() {
    for (std::size_t t = 0; t < before_.size(); ++t)
      if (before_[root(t)]) return std::nullopt;  // round and round
    const auto busy = busy_time();
    if (!busy) return std::nullopt;
    find_steps(*busy);
    result_.resize(node_.tasks.size());
    for (std::size_t t = 0; t < node_.tasks.size(); ++t)
      if (!before_[t]) result_[t] = first_of_chain(t, *busy);
    // Chains that end before they begin again meet none of their own earlier jobs.
    for (const bool apart : {true, false}) {
      bool confirmed = true;
      for (std::size_t t = 0; t < node_.tasks.size(); ++t)
        if (before_[t]) follow(t, apart);
      for (std::size_t t = 0; t < node_.tasks.size(); ++t)
        if (before_[t] && (!result_[root(t)].gap || ended(t) >= result_[root(t)].gap->ns)) confirmed = false;
      if (confirmed) break;
    }
    return result_;
  }

  // Of a task that messages activate, others ahead of it.
  std::optional<Duration> response_behind(std::size_t task, std::span<const Duration> ahead) {
    const auto busy = busy_time();
    if (!busy) return std::nullopt;
    for (std::size_t t = 0; t < ahead.size(); ++t) ahead_[t] = ahead[t].ns;
    find_steps(*busy);
    return first_of_chain(task, *busy).worst;
  }

 private:
  // The windows from which one more message may be in.
  void find_steps(std::int64_t busy) {
    for (std::size_t t = 0; t < node_.tasks.size(); ++t) {
      if (before_[t] || by_time(t)) continue;
      if (ahead_[t] > 0) steps_.push_back(ahead_[t]);
      for (const ActivationBound& from : bounds_[t].all)
        for (std::int64_t at = from.period - from.jitter % from.period; at <= busy; at += from.period)
          steps_.push_back(ahead_[t] + at);
      // Behind its step its work grows more slowly than the window.
      if (const auto& following = following_[t]) steps_.push_back(ahead_[t] + following->round());
    }
    std::sort(steps_.begin(), steps_.end());
    steps_.erase(std::unique(steps_.begin(), steps_.end()), steps_.end());
  }

  bool by_time(std::size_t task) const { return node_.tasks[task].activation.kind == model::ActivationKind::kTime; }

  std::size_t root(std::size_t task) const {
    for (std::size_t steps = 0; before_[task] && steps < before_.size(); ++steps) task = *before_[task];
    return task;
  }

  bool leads_to(std::size_t from, std::size_t to) const {
    for (std::size_t steps = 0; steps <= before_.size(); ++steps) {
      if (from == to) return true;
      if (!before_[to]) return false;
      to = *before_[to];
    }
    return false;
  }

  // A distance of global time in the node's own: every cycle may be shorter by the rate correction, every second one by
  // an offset correction, external terms included.
  std::int64_t shrunk(std::int64_t global_ns) const {
    if (global_ns == 0 || !node_.flexray) return global_ns;
    const model::NodeParameters& p = *node_.flexray;
    const std::int64_t rate =
        static_cast<std::int64_t>(static_cast<Int128>(global_ns) * (p.pRateCorrectionOut + p.pExternRateCorrection) /
                                  std::max(p.pMicroPerCycle, 1)) +
        1;
    const std::int64_t offset = (p.pOffsetCorrectionOut + p.pExternOffsetCorrection) * p.pdMicrotick_ps / 1000 + 1;
    const std::int64_t corrections = global_ns / (2 * std::max<std::int64_t>(1, cluster_.cycle().ns)) + 1;
    return std::max<std::int64_t>(0, global_ns - rate - offset * corrections - model::kGranularity_ns);
  }

  // The k-th instant from the given one on, forward or backward, as its distance in global time and its task.
  std::pair<std::int64_t, std::size_t> neighbour(std::size_t from, std::size_t k, bool forward) const {
    const std::size_t count = instants_.size();
    const std::size_t rounds = k / count, rest = k % count;
    const std::size_t to = forward ? (from + rest) % count : (from + count - rest) % count;
    const bool wrapped = forward ? to < from : to > from;
    const std::int64_t apart =
        forward ? instants_[to].first - instants_[from].first : instants_[from].first - instants_[to].first;
    return {apart + round_ * (static_cast<std::int64_t>(rounds) + (wrapped ? 1 : 0)), instants_[to].second};
  }

  // The work that time brings from one instant on, or up to it, in windows up to `most`.
  std::vector<Load> loads(std::size_t instant, std::int64_t most, bool forward) const {
    std::vector<Load> list;
    for (std::size_t k = 0;; ++k) {
      const auto [apart, task] = neighbour(instant, k, forward);
      const std::int64_t window = shrunk(apart);
      if (window > most) break;
      list.push_back({window, whole_[task]});
    }
    std::sort(list.begin(), list.end(), [](const Load& a, const Load& b) { return a.window < b.window; });
    return list;
  }

  // No more than twice what is looked into: enough to know that it never ends.
  std::int64_t sporadic(std::int64_t window) const {
    Int128 work = 0;
    for (std::size_t t = 0; t < node_.tasks.size(); ++t) {
      if (before_[t] || by_time(t)) continue;
      // Whose newest activation was some time ago has none in the last of the window.
      const std::int64_t before = window - ahead_[t];
      if (before < 0) continue;
      if (const auto& following = following_[t])
        work += whole_[t] + following->before_last(before);
      else
        work += static_cast<Int128>(whole_[t]) * bounds_[t].most(before);
    }
    return static_cast<std::int64_t>(std::min<Int128>(work, 2 * kLongest_ns));
  }

  // The smallest A with W(A) <= A, from below.
  std::optional<std::int64_t> busy_time() const {
    const std::int64_t limit = longest_busy_time(cluster_, node_).ns;
    // Corrections that eat up cycles: not a clock to count on.
    if (!instants_.empty() && shrunk(round_) < round_ / 2) return std::nullopt;
    std::int64_t window = 0;
    for (int rounds = 0; rounds < kMostRounds; ++rounds) {
      std::int64_t timed = 0;
      for (std::size_t i = 0; i < instants_.size(); ++i) {
        std::int64_t work = 0;
        for (const Load& load : loads(i, window, true)) work += load.work;
        timed = std::max(timed, work);
      }
      const std::int64_t next = sporadic(window) + timed;
      if (next <= window) return window;
      if (next > limit) return std::nullopt;
      window = next;
    }
    return std::nullopt;
  }

  // The largest W(a) - a, with what time brings given.
  std::int64_t latest(const std::vector<Load>& timed) const {
    std::int64_t worst = 0, work = 0;
    std::size_t next = 0;
    const auto look = [&](std::int64_t window) {
      for (; next < timed.size() && timed[next].window <= window; ++next) work += timed[next].work;
      worst = std::max(worst, sporadic(window) + work - window);
    };
    look(0);
    std::size_t step = 0;
    while (step < steps_.size() || next < timed.size())
      if (next == timed.size() || (step < steps_.size() && steps_[step] <= timed[next].window))
        look(steps_[step++]);
      else
        look(timed[next].window);
    return worst;
  }

  TaskResponse first_of_chain(std::size_t task, std::int64_t busy) const {
    std::int64_t worst = instants_.empty() ? latest({}) : 0;
    for (std::size_t i = 0; i < instants_.size(); ++i)
      if (!by_time(task) || instants_[i].second == task)
        worst = std::max(worst, latest(loads(i, busy, !by_time(task))));
    TaskResponse response;
    // What follows the task itself is not before it.
    response.worst = {worst - whole_[task] + node_.tasks[task].worst_case.ns};
    if (by_time(task))
      response.gap = Duration{shrunk(cluster_.cycle().ns * node_.tasks[task].activation.at.repetition)};
    else if (const auto gap = bounds_[task].gap())
      response.gap = Duration{*gap};
    set_written(task, response);
    return response;
  }

  void set_written(std::size_t task, TaskResponse& response) const {
    const model::Task& what = node_.tasks[task];
    const Duration best = shortest_execution(what);
    if (const auto& following = following_[task])
      response.written = Duration{following->round()};
    else if (response.gap)
      response.written = Duration{std::max<std::int64_t>(0, (*response.gap - (response.worst - best)).ns)};
  }

  // From the activation of the chain's first task to the end of this one.
  std::int64_t ended(std::size_t task) const {
    std::int64_t sum = result_[task].worst.ns;
    return before_[task] ? sum + ended(*before_[task]) : sum;
  }

  void follow(std::size_t task, bool chains_apart) {
    const std::size_t previous = *before_[task];
    if (before_[previous]) follow(previous, chains_apart);
    std::int64_t worst = node_.tasks[task].worst_case.ns;
    for (std::size_t other = 0; other < node_.tasks.size(); ++other)
      if (other != task && other != previous && may_be_before(task, other, chains_apart))
        worst += node_.tasks[other].worst_case.ns;
    TaskResponse response;
    response.worst = {worst};
    response.gap = result_[previous].written;
    set_written(task, response);
    result_[task] = response;
  }

  // May `other` be activated between the activation of the task before `task` and its end?
  bool may_be_before(std::size_t task, std::size_t other, bool chains_apart) const {
    const std::size_t first = root(task);
    if (root(other) == first) return !chains_apart || !(leads_to(other, task) || leads_to(task, other));
    if (!by_time(first) || !by_time(other)) return true;
    for (std::size_t i = 0; i < instants_.size(); ++i) {
      if (instants_[i].second != first) continue;
      for (const bool forward : {true, false})  // backward for what time has at the same instant
        for (std::size_t k = 0;; ++k) {
          const auto [apart, at] = neighbour(i, k, forward);
          if (shrunk(apart) > (forward ? ended(*before_[task]) : 0)) break;
          if (at == other) return true;
        }
    }
    return false;
  }

  const model::Cluster& cluster_;
  const model::Node& node_;
  std::vector<std::optional<std::size_t>> before_;              // the task whose end activates it
  std::vector<std::int64_t> ahead_;                             // how long ago its newest activation was, at least
  std::vector<std::int64_t> whole_;                             // of a chain, at its first task
  std::vector<ActivationBounds> bounds_;                        // of first tasks that messages and sensors activate
  std::vector<std::optional<Following>> following_;             // of first tasks that a sensor waits for
  std::vector<std::pair<std::int64_t, std::size_t>> instants_;  // of 64 cycles, in global time, and the task
  std::int64_t round_ = 0;
  std::vector<std::int64_t> steps_;  // see find_steps()
  std::vector<TaskResponse> result_;
};

}  // namespace

Duration longest_busy_time(const model::Cluster& cluster, const model::Node& node) {
  for (const model::Task& task : node.tasks)
    if (task.activation.kind == model::ActivationKind::kTime) return cluster.cycle() * model::kCycles;
  return {kLongest_ns};
}

std::optional<std::vector<TaskResponse>> worst_responses(const model::Cluster& cluster, NodeId node,
                                                         WritersOfLists writers) {
  return NodeTasks(cluster, node, writers).responses();
}

std::optional<Duration> worst_response(const model::Cluster& cluster, NodeId node, std::size_t task,
                                       std::span<const Duration> ahead) {
  NodeTasks tasks(cluster, node, WritersOfLists::kKnown);
  if (std::any_of(ahead.begin(), ahead.end(), [](Duration lead) { return lead > Duration{}; }))
    return tasks.response_behind(task, ahead);
  const auto all = tasks.responses();
  if (!all) return std::nullopt;
  return (*all)[task].worst;
}

}  // namespace ttf::schedules::analysis
