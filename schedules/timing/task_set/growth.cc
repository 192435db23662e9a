#include "schedules/timing/task_set/growth.h"

#include <algorithm>
#include <optional>
#include <span>

#include "schedules/timing/response/can.h"

namespace ttf::schedules::timing::task_set {
namespace {

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

}  // namespace

std::vector<std::size_t> endless_jitters(const TaskSet& set, const std::vector<std::vector<std::size_t>>& by_priority) {
  return JitterLines(set, by_priority).endless();
}

}  // namespace ttf::schedules::timing::task_set
