#include "tests/schedules/timing/response/load_tests.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/check.h"
#include "core/int128.h"

namespace ttf::schedules::timing::response {
namespace {

constexpr double kMargin = 1e-12;  // more than the rounding of sums and products of some thousand loads

double load_of_task(const TaskTimes& task) { return static_cast<double>(task.work) / static_cast<double>(task.period); }

bool tests_apply(std::span<const TaskTimes> tasks) {
  return std::all_of(tasks.begin(), tasks.end(), [](const TaskTimes& task) {
    return task.jitter == 0 && task.blocking == 0 && task.deadline >= task.period;
  });
}

// A product of fractions above zero, as long as it fits.
class Fraction {
 public:
  bool times(std::int64_t over, std::int64_t under) {
    const std::int64_t common = std::gcd(over, under);
    return !__builtin_mul_overflow(over_, over / common, &over_) &&
           !__builtin_mul_overflow(under_, under / common, &under_) && under_ < (Int128{1} << 126);
  }
  bool at_most_two() const { return over_ <= 2 * under_; }

 private:
  Int128 over_ = 1, under_ = 1;
};

}  // namespace

double utilisation(std::span<const TaskTimes> tasks) {
  double sum = 0.0;
  for (const TaskTimes& task : tasks) sum += load_of_task(task);
  return sum;
}

double liu_layland_bound(std::size_t tasks) {
  TTF_CHECK(tasks >= 1, "a bound for no task");
  const auto n = static_cast<double>(tasks);
  return n * std::expm1(std::log(2.0) / n);  // 2^(1/n) - 1 without cancellation
}

bool passes_liu_layland(std::span<const TaskTimes> tasks) {
  if (tasks.empty()) return true;
  if (!tests_apply(tasks)) return false;
  // The limit of several tasks is irrational.
  if (tasks.size() == 1) return tasks[0].work <= tasks[0].period;
  return utilisation(tasks) <= liu_layland_bound(tasks.size()) - kMargin;
}

bool passes_hyperbolic(std::span<const TaskTimes> tasks) {
  if (!tests_apply(tasks)) return false;
  Fraction exact;
  bool fits = true;
  double product = 1.0;
  for (const TaskTimes& task : tasks) {
    fits = fits && exact.times(task.work + task.period, task.period);
    product *= 1.0 + load_of_task(task);
  }
  return fits ? exact.at_most_two() : product <= 2.0 - kMargin;
}

}  // namespace ttf::schedules::timing::response
