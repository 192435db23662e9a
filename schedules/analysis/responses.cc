#include "schedules/analysis/responses.h"

#include <algorithm>
#include <utility>

#include "core/check.h"
#include "schedules/analysis/processor/busy_period.h"
#include "schedules/analysis/sensor_loop.h"
#include "schedules/model/round.h"

namespace ttf::schedules::analysis {
namespace {

bool by_time(const model::Task& task) { return task.activation.kind == model::ActivationKind::kTime; }

// Returns by task the one whose end activates it.
std::vector<std::optional<std::size_t>> predecessors(const std::vector<model::Task>& tasks) {
  std::vector<std::optional<std::size_t>> before(tasks.size());
  for (std::size_t t = 0; t < tasks.size(); ++t)
    if (tasks[t].activation.kind == model::ActivationKind::kCompletion)
      for (std::size_t other = 0; other < tasks.size(); ++other)
        if (tasks[other].name == tasks[t].activation.after) before[t] = other;
  return before;
}

// Returns the most by which the node's corrections can shorten a distance of global time.
std::optional<processor::ClockCorrections> corrections_of(const model::Cluster& cluster, const model::Node& node) {
  if (!node.flexray) return std::nullopt;
  const model::NodeParameters& p = *node.flexray;
  return processor::ClockCorrections{
      .cycle_ns = std::max<std::int64_t>(1, cluster.cycle().ns),
      .microticks = std::max(p.pMicroPerCycle, 1),
      .rate = p.pRateCorrectionOut + p.pExternRateCorrection,
      .offset_ns = (p.pOffsetCorrectionOut + p.pExternOffsetCorrection) * p.pdMicrotick_ps / 1000 + 1};
}

class ChainAnalysis {
 public:
  ChainAnalysis(const model::Cluster& cluster, NodeId id, WritersOfLists writers)
      : cluster_(cluster), node_(cluster.node(id)), before_(predecessors(node_.tasks)), chain_(node_.tasks.size()) {
    std::vector<processor::TimedInstants::Instant> instants;
    for (std::size_t t = 0; t < node_.tasks.size(); ++t) {
      if (before_[t]) continue;
      chain_[t] = set_.chains.size();
      set_.chains.push_back({0, activation_of(id, node_.tasks[t], writers)});
      if (by_time(node_.tasks[t])) add_instants(t, instants);
    }
    const std::int64_t round = time_of(cluster.flexray, cycles_per_round(cluster.flexray), Macroticks{0}).ns;
    set_.timed = processor::TimedInstants(std::move(instants), round, corrections_of(cluster, node_));
    for (std::size_t t = 0; t < node_.tasks.size(); ++t) {
      chain_[t] = chain_[first_of(t)];
      if (chain_[t]) chain_of(t).work += node_.tasks[t].worst_case.ns;
    }
  }

  std::optional<std::vector<TaskResponse>> responses() const {
    if (std::any_of(chain_.begin(), chain_.end(), [](const auto& chain) { return !chain; })) return std::nullopt;
    const auto busy = busy_time(set_, longest_busy_time(cluster_, node_).ns);
    if (!busy) return std::nullopt;
    Responses all(node_.tasks.size());
    for (std::size_t t = 0; t < node_.tasks.size(); ++t)
      if (!before_[t]) all[t] = of_first(t, *busy, {});
    // Chains that end before they begin again do not meet their own earlier jobs.
    add_followers(all, Jobs::kApart);
    if (!chains_end_in_time(all)) add_followers(all, Jobs::kMixed);
    return all;
  }

  // Returns the response of a task that messages activate, with leads of others.
  std::optional<Duration> response_behind(std::size_t task, std::span<const Duration> ahead) const {
    TTF_CHECK(!before_[task], "task {} follows another", task);
    const auto busy = busy_time(set_, longest_busy_time(cluster_, node_).ns);
    if (!busy) return std::nullopt;
    std::vector<std::int64_t> by_chain(set_.chains.size());
    for (std::size_t t = 0; t < node_.tasks.size(); ++t)
      if (!before_[t]) by_chain[*chain_[t]] = ahead[t].ns;
    return of_first(task, *busy, by_chain).worst;
  }

 private:
  using Responses = std::vector<TaskResponse>;

  // Whether the jobs of a chain's next activation may wait among those of the last one.
  enum class Jobs : bool { kApart, kMixed };

  processor::Chain::Activation activation_of(NodeId id, const model::Task& first, WritersOfLists writers) const {
    if (by_time(first)) return processor::ByTime{};
    if (const auto loop = loop_through(cluster_, id, first))
      return processor::ByFollower{shortest_execution(first).ns, first.worst_case.ns,
                                   std::max<std::int64_t>(1, shortest_return(cluster_, *loop).ns)};
    return activation_bounds(cluster_, first, writers);
  }

  void add_instants(std::size_t task, std::vector<processor::TimedInstants::Instant>& instants) const {
    const model::CycleInstant& at = node_.tasks[task].activation.at;
    for (std::int64_t cycle = at.base_cycle; cycle < cycles_per_round(cluster_.flexray); cycle += at.repetition)
      instants.push_back({time_of(cluster_.flexray, cycle, at.offset).ns, *chain_[task]});
  }

  // Returns the chain's first task; any task of a ring.
  std::size_t first_of(std::size_t task) const {
    for (std::size_t steps = 0; before_[task] && steps < before_.size(); ++steps) task = *before_[task];
    return task;
  }

  bool leads_to(std::size_t from, std::size_t to) const {
    while (from != to && before_[to]) to = *before_[to];
    return from == to;
  }

  const processor::Chain& chain_of(std::size_t task) const { return set_.chains[*chain_[task]]; }
  processor::Chain& chain_of(std::size_t task) { return set_.chains[*chain_[task]]; }

  TaskResponse of_first(std::size_t task, std::int64_t busy, std::span<const std::int64_t> ahead) const {
    const model::Task& first = node_.tasks[task];
    const processor::Chain& chain = chain_of(task);
    TaskResponse response;
    // The tasks that follow do not run before this one.
    response.worst = {worst_chain_response(set_, *chain_[task], busy, ahead) - chain.work + first.worst_case.ns};
    if (by_time(first)) {
      response.gap = Duration{set_.timed.shortest(cluster_.cycle().ns * first.activation.at.repetition)};
    } else if (const auto* bounds = std::get_if<processor::ActivationBounds>(&chain.activation)) {
      if (const auto gap = bounds->gap()) response.gap = Duration{*gap};
    }
    if (const auto* follower = std::get_if<processor::ByFollower>(&chain.activation))
      response.written = Duration{follower->shortest_round()};
    else
      response.written = shortest_written(first, response);
    return response;
  }

  // Returns the shortest time between two ends: one late, the next at once.
  static std::optional<Duration> shortest_written(const model::Task& task, const TaskResponse& response) {
    if (!response.gap) return std::nullopt;
    return std::max(Duration{}, *response.gap - (response.worst - shortest_execution(task)));
  }

  void add_followers(Responses& all, Jobs jobs) const {
    std::vector<bool> done(all.size());
    for (std::size_t t = 0; t < all.size(); ++t) add_follower(t, jobs, all, done);
  }

  // Adds its predecessors first.
  void add_follower(std::size_t task, Jobs jobs, Responses& all, std::vector<bool>& done) const {
    if (done[task] || !before_[task]) return;
    add_follower(*before_[task], jobs, all, done);
    all[task] = of_follower(task, jobs, all);
    done[task] = true;
  }

  // It waits for all tasks activated while its predecessor waited and ran.
  TaskResponse of_follower(std::size_t task, Jobs jobs, const Responses& all) const {
    const std::size_t previous = *before_[task];
    const std::int64_t since = until_end(previous, all);
    TaskResponse response;
    response.worst = node_.tasks[task].worst_case;
    for (std::size_t other = 0; other < node_.tasks.size(); ++other)
      if (other != task && other != previous && may_be_before(task, other, jobs, since))
        response.worst += node_.tasks[other].worst_case;
    response.gap = all[previous].written;
    response.written = shortest_written(node_.tasks[task], response);
    return response;
  }

  // Returns whether `other` may be activated between the activation and the end of the predecessor of `task`.
  // `since` is the time from the activation of their chain to that end.
  bool may_be_before(std::size_t task, std::size_t other, Jobs jobs, std::int64_t since) const {
    if (chain_[other] == chain_[task]) return jobs == Jobs::kMixed || !(leads_to(other, task) || leads_to(task, other));
    if (!chain_of(task).by_time() || !by_time(node_.tasks[other])) return true;
    for (std::size_t i = 0; i < set_.timed.size(); ++i)
      if (set_.timed.chain(i) == chain_[task] && activates_within(i, *chain_[other], since)) return true;
    return false;
  }

  // Returns whether time activates the chain from this instant until `since` after it, or at the same instant.
  bool activates_within(std::size_t instant, std::size_t chain, std::int64_t since) const {
    const auto is_it = [chain](const processor::TimedInstants::Neighbour& other) { return other.chain == chain; };
    const auto behind = set_.timed.within(instant, since, processor::TimedInstants::kForward);
    const auto beside = set_.timed.within(instant, 0, processor::TimedInstants::kBackward);
    return std::any_of(behind.begin(), behind.end(), is_it) || std::any_of(beside.begin(), beside.end(), is_it);
  }

  // Returns the time from the activation of the chain's first task to the end of this one.
  std::int64_t until_end(std::size_t task, const Responses& all) const {
    const std::int64_t own = all[task].worst.ns;
    return before_[task] ? until_end(*before_[task], all) + own : own;
  }

  bool chains_end_in_time(const Responses& all) const {
    for (std::size_t t = 0; t < all.size(); ++t) {
      const auto& gap = all[first_of(t)].gap;
      if (before_[t] && (!gap || until_end(t, all) >= gap->ns)) return false;
    }
    return true;
  }

  const model::Cluster& cluster_;
  const model::Node& node_;
  std::vector<std::optional<std::size_t>> before_;  // the task whose end activates it
  std::vector<std::optional<std::size_t>> chain_;   // index in set_; absent for tasks in a ring
  processor::TaskChains set_;
};

// The executions of a task with modes do not meet: it is its node's only task, and the rule about modes holds them apart
// (schedules/modes). The time between two of its lists is not known here.
std::optional<std::vector<TaskResponse>> alone_with_modes(const model::Node& node) {
  if (node.tasks.size() != 1 || node.tasks[0].modes.empty()) return std::nullopt;
  return std::vector{TaskResponse{node.tasks[0].worst_case, std::nullopt, std::nullopt}};
}

}  // namespace

Duration least_apart(const model::Cluster& cluster, const model::Node& node, Duration time) {
  const auto corrections = corrections_of(cluster, node);
  if (!corrections) return time;
  // A distance grows by less than its surplus: steps by the missing time end from below.
  Duration apart = time;
  for (Duration missing = time; missing > Duration{}; apart += missing) {
    missing = time - Duration{corrections->shortest(apart.ns)};
    if (missing <= Duration{}) break;
    if (apart > Duration{100 * time.ns + 1'000'000'000}) break;  // corrections that leave no time at all
  }
  return apart;
}

Duration longest_busy_time(const model::Cluster& cluster, const model::Node& node) {
  if (std::any_of(node.tasks.begin(), node.tasks.end(), by_time)) return cluster.cycle() * model::kMostCycles;
  return {processor::kLongestBusy_ns};
}

std::optional<std::vector<TaskResponse>> worst_responses(const model::Cluster& cluster, NodeId node,
                                                         WritersOfLists writers) {
  if (const auto alone = alone_with_modes(cluster.node(node))) return alone;
  return ChainAnalysis(cluster, node, writers).responses();
}

std::optional<Duration> worst_response(const model::Cluster& cluster, NodeId node, std::size_t task,
                                       std::span<const Duration> ahead) {
  if (const auto alone = alone_with_modes(cluster.node(node))) return alone->front().worst;
  const ChainAnalysis tasks(cluster, node, WritersOfLists::kKnown);
  if (std::any_of(ahead.begin(), ahead.end(), [](Duration lead) { return lead > Duration{}; }))
    return tasks.response_behind(task, ahead);
  const auto all = tasks.responses();
  if (!all) return std::nullopt;
  return (*all)[task].worst;
}

}  // namespace ttf::schedules::analysis
