#include "schedules/timing/task_set/responses.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "schedules/timing/response/can.h"
#include "schedules/timing/task_set/resource_responses.h"
#include "schedules/timing/task_set/table.h"
#include "schedules/timing/task_set/task_set.h"

namespace ttf::schedules::timing::task_set {
namespace {

// Jitters of activations that grow without end.
//
// A task that a activates has a jitter of R_a less a's shortest time. With higher priorities j, of loads U_j, and U
// their sum, R_a lies between two lines of the same slope:
//   J_a + (C_a + sum_j U_j J_j) / (1 - U)  <=  R_a  <=  J_a + (C_a + B + sum_j (C_j + U_j J_j)) / (1 - U)
// (fluid bounds; E. Bini, T. H. C. Nguyen, P. Richard, S. K. Baruah, IEEE Transactions on Computers 58(2), 2009). So
// jitters obey J >= A J + b, and the least solution is finite if, and only if, no cycle of dependences has a spectral
// radius of one or more. I - A then is an M-matrix: Gauss' elimination finds positive pivots alone (A. Berman, R.
// Plemmons: Nonnegative Matrices in the Mathematical Sciences, chapter 6). Where a pivot is not positive, its jitter
// has no end.

constexpr double kLeastPivot = 1e-9;

class JitterLines {
 public:
  JitterLines(const TaskSet& set, const std::vector<std::vector<std::size_t>>& by_priority)
      : set_(set), by_priority_(by_priority), unknown_(set.tasks.size()) {
    for (std::size_t t = 0; t < set.tasks.size(); ++t) {
      if (!set.tasks[t].activator) continue;
      unknown_[t] = activated_.size();
      activated_.push_back(t);
    }
    for (const std::size_t t : activated_) rows_.push_back(row_of(*set.tasks[t].activator));
    for (std::size_t k = 0; k < rows_.size(); ++k) rows_[k][k] += 1.0;
  }

  std::vector<std::size_t> endless() {
    std::vector<std::size_t> found;
    for (std::size_t k = 0; k < rows_.size(); ++k) {
      if (rows_[k][k] <= kLeastPivot)
        found.push_back(activated_[k]);
      else
        eliminate(k);
    }
    return found;
  }

 private:
  double load(std::size_t t) const { return set_.tasks[t].worst.seconds() / set_.period_of(t).seconds(); }

  // -A in the row of a task that `activator` activates.
  std::vector<double> row_of(std::size_t activator) const {
    std::vector<double> row(activated_.size(), 0.0);
    const Task& task = set_.tasks[activator];
    if (task.communication == Communication::kLet) return row;  // it ends at its deadline
    if (unknown_[activator]) row[*unknown_[activator]] -= 1.0;
    const Resource& on = set_.resources[task.resource];
    if (!on.has_priorities() || on.policy == Policy::kDynamic) return row;
    const std::vector<std::size_t>& order = by_priority_[task.resource];
    const auto end = std::ranges::find(order, activator);
    const std::span higher(order.begin(), end);
    double left = 1.0 - error_load(on, std::span(order.begin(), end + 1));
    for (const std::size_t t : higher) left -= load(t);
    if (left <= 0.0) return row;  // its response itself has no bound
    for (const std::size_t t : higher)
      if (unknown_[t]) row[*unknown_[t]] -= load(t) / left;
    return row;
  }

  double error_load(const Resource& on, std::span<const std::size_t> up_to_activator) const {
    if (!on.errors_apart) return 0.0;
    Duration longest{};
    for (const std::size_t t : up_to_activator) longest = std::max(longest, set_.tasks[t].worst);
    const std::int64_t each = longest.ns + response::kCanErrorBits * response::can_time_ns(1, on.bit_rate);
    return static_cast<double>(each) / static_cast<double>(on.errors_apart->ns);
  }

  void eliminate(std::size_t k) {
    for (std::size_t i = k + 1; i < rows_.size(); ++i) {
      if (rows_[i][k] == 0.0) continue;
      const double factor = rows_[i][k] / rows_[k][k];
      for (std::size_t j = k; j < rows_.size(); ++j) rows_[i][j] -= factor * rows_[k][j];
    }
  }

  const TaskSet& set_;
  const std::vector<std::vector<std::size_t>>& by_priority_;
  std::vector<std::optional<std::size_t>> unknown_;  // by task
  std::vector<std::size_t> activated_;
  std::vector<std::vector<double>> rows_;  // of I - A
};

// Takes the tasks of each resource by priority. Returns the activated tasks, one or more of each cycle of dependences
// that has no solution, or is within 1e-9 of that. A dynamic segment counts without its lost cycles, so that cycles of
// dependences over one may have no solution all the same.
std::vector<std::size_t> endless_jitters(const TaskSet& set, const std::vector<std::vector<std::size_t>>& by_priority) {
  return JitterLines(set, by_priority).endless();
}

using response::Quality;
using response::Response;

constexpr int kMostRounds = 1000;
constexpr Duration kLongestJitter{response::kLongestArgument / 2};

class Analysis {
 public:
  explicit Analysis(const TaskSet& set) : set_(set), unknown_(set.tasks.size()) {
    found_.tasks.resize(set.tasks.size());
    for (std::size_t r = 0; r < set.resources.size(); ++r) found_.resources.push_back(in_first_order(r));
  }

  Responses run() {
    settle_priorities();
    for (std::size_t r = 0; r < set_.resources.size(); ++r) add_misses(r);
    return std::move(found_);
  }

 private:
  // Tries Audsley's algorithm where the first order misses a deadline.
  void settle_priorities() {
    iterate();
    for (std::size_t r = 0; r < set_.resources.size(); ++r) {
      ResourceTiming& here = found_.resources[r];
      if (here.assignment != Assignment::kDeadlineMonotonic || all_in_time(r)) continue;
      const std::vector<std::size_t> before = here.by_priority;
      here.assignment = Assignment::kNone;
      const std::optional<std::vector<std::size_t>> order = other_order(r);
      if (!order) continue;
      here.by_priority = *order;
      iterate();
      if (all_in_time(r)) {
        here.assignment = Assignment::kAudsley;
        continue;
      }
      here.by_priority = before;
      iterate();
    }
  }

  ResourceTiming in_first_order(std::size_t r) const {
    ResourceTiming here;
    here.by_priority = set_.tasks_on(r);
    std::vector<TableEntry> table;
    bool given = false;
    for (const std::size_t t : here.by_priority) {
      const Task& task = set_.tasks[t];
      here.load += task.worst.seconds() / set_.period_of(t).seconds();
      given = given || task.priority.has_value();
      table.push_back({.period = set_.period_of(t), .offset = task.offset.value_or(Duration{}), .worst = task.worst});
    }
    const Resource& resource = set_.resources[r];
    if (resource.policy == Policy::kDynamic)
      here.load *= resource.cycle.seconds() / (resource.minislot * resource.minislots).seconds();
    if (resource.policy == Policy::kTable) {
      if (const auto overlap = overlap_in(table))
        here.overlap = {here.by_priority[overlap->first], here.by_priority[overlap->second]};
    }
    if (!resource.has_priorities()) return here;
    const auto key = [&](std::size_t t) {
      const Task& task = set_.tasks[t];
      if (given) return task.priority.value_or(0);
      return task.deadline ? task.deadline->ns : std::numeric_limits<std::int64_t>::max();
    };
    std::ranges::stable_sort(here.by_priority, {}, key);
    here.assignment = given ? Assignment::kGiven : Assignment::kDeadlineMonotonic;
    return here;
  }

  // Begins without jitters of activations, which then only grow.
  void iterate() {
    unknown_.assign(set_.tasks.size(), false);
    for (std::size_t t = 0; t < set_.tasks.size(); ++t) {
      found_.tasks[t] = TaskTiming{};
      found_.tasks[t].jitter = set_.tasks[t].jitter;
    }
    std::vector<std::vector<std::size_t>> orders;
    for (const ResourceTiming& here : found_.resources) orders.push_back(here.by_priority);
    for (const std::size_t t : endless_jitters(set_, orders)) unknown_[t] = true;
    found_.rounds = 0;
    do {
      for (std::size_t r = 0; r < set_.resources.size(); ++r) respond(r);
    } while (activations_change(++found_.rounds > kMostRounds));
  }

  // Behind a task without a bound, those of lower priority have none.
  void respond(std::size_t r) {
    const std::vector<std::size_t>& order = found_.resources[r].by_priority;
    const std::vector<Response> responses = responses_on(r);
    bool bounded = true;
    for (std::size_t p = 0; p < order.size(); ++p) {
      if (!set_.resources[r].has_priorities()) bounded = true;
      bounded = bounded && !unknown_[order[p]];
      found_.tasks[order[p]].response = bounded ? responses[p] : Response{};
    }
  }

  std::vector<Response> responses_on(std::size_t r) const {
    const ResourceTiming& here = found_.resources[r];
    if (set_.resources[r].policy != Policy::kTable) return resource_responses(set_, {r, here.by_priority, jitters(r)});
    std::vector<Response> responses;
    for (const std::size_t t : here.by_priority)
      responses.push_back(here.overlap.empty() ? Response{Quality::kExact, set_.tasks[t].worst.ns} : Response{});
    return responses;
  }

  // Returns the jitters of a resource's tasks by priority; 0 where there is no bound.
  std::vector<Duration> jitters(std::size_t r) const {
    std::vector<Duration> found;
    for (const std::size_t t : found_.resources[r].by_priority)
      found.push_back(unknown_[t] ? Duration{} : found_.tasks[t].jitter);
    return found;
  }

  // Takes responses into jitters; returns whether anything has changed. `stop` gives up the jitters that still grow.
  bool activations_change(bool stop) {
    bool changed = false;
    for (std::size_t t = 0; t < set_.tasks.size(); ++t) {
      const Task& task = set_.tasks[t];
      TaskTiming next = found_.tasks[t];
      Duration start{};
      if (task.activator) {
        const TaskTiming& before = found_.tasks[*task.activator];
        start = before.shortest;
        next.jitter = before.longest - before.shortest;
        const bool gives_up = stop && next.jitter != found_.tasks[t].jitter;
        if (!unknown_[t] && (gives_up || !activates(*task.activator) || next.jitter > kLongestJitter))
          unknown_[t] = changed = true;
        if (unknown_[t]) next.jitter = Duration{};
      }
      const bool let = task.communication == Communication::kLet;
      next.shortest = start + (let ? *task.deadline : task.best);
      next.longest = start + (let ? *task.deadline : Duration{next.response.longest});
      const TaskTiming& last = found_.tasks[t];
      if (next.jitter != last.jitter || next.shortest != last.shortest || next.longest != last.longest) changed = true;
      found_.tasks[t] = next;
    }
    return changed;
  }

  // Returns whether the task's longest time is known, so that it activates another one by then.
  bool activates(std::size_t t) const {
    const Task& task = set_.tasks[t];
    if (unknown_[t] || !found_.tasks[t].bounded()) return false;
    return task.communication != Communication::kLet || found_.tasks[t].response.keeps(task.deadline->ns);
  }

  bool all_in_time(std::size_t r) const {
    return std::ranges::all_of(found_.resources[r].by_priority,
                               [&](std::size_t t) { return keeps_deadline(set_, found_, t); });
  }

  std::optional<std::vector<std::size_t>> other_order(std::size_t r) const {
    const std::vector<std::size_t>& places = found_.resources[r].by_priority;
    if (std::ranges::any_of(places, [&](std::size_t t) { return unknown_[t]; })) return std::nullopt;
    return audsleys_order(set_, {r, places, jitters(r)});
  }

  void add_misses(std::size_t r) {
    const std::vector<std::size_t>& order = found_.resources[r].by_priority;
    const std::vector<double> misses = miss_probabilities(set_, {r, order, jitters(r)});
    for (std::size_t p = 0; p < misses.size(); ++p) {
      if (unknown_[order[p]]) return;  // nothing is known of lower priorities either
      found_.tasks[order[p]].miss_probability = misses[p];
    }
  }

  const TaskSet& set_;
  std::vector<bool> unknown_;  // an activated task whose jitter has no bound
  Responses found_;
};

}  // namespace

Responses responses_of(const TaskSet& set) { return Analysis(set).run(); }

bool keeps_deadline(const TaskSet& set, const Responses& responses, std::size_t task) {
  const response::Response& found = responses.tasks[task].response;
  if (!set.tasks[task].deadline) return found.bounded();
  return found.keeps(set.tasks[task].deadline->ns);
}

std::string words(Assignment assignment) {
  switch (assignment) {
    case Assignment::kGiven: return "as given";
    case Assignment::kDeadlineMonotonic: return "deadline monotonic";
    case Assignment::kAudsley: return "by Audsley's algorithm";
    case Assignment::kNone: break;
  }
  return "deadline monotonic (no order found that meets all deadlines)";
}

}  // namespace ttf::schedules::timing::task_set
