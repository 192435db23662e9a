#include "tests/schedules/timing/waters.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/check.h"

namespace ttf::schedules::timing {
namespace {

constexpr std::array<WatersRow, 9> kWatersRows{{
    {1, 3, 0.34, 5.00, 30.11, 1.30, 29.11},
    {2, 2, 0.32, 4.20, 40.69, 1.54, 19.04},
    {5, 2, 0.36, 11.04, 83.38, 1.13, 18.44},
    {10, 25, 0.21, 10.09, 309.87, 1.06, 30.03},
    {20, 25, 0.25, 8.74, 291.42, 1.06, 15.61},
    {50, 3, 0.29, 17.56, 92.98, 1.13, 7.76},
    {100, 20, 0.21, 10.53, 420.43, 1.02, 8.88},
    {200, 1, 0.22, 2.56, 21.95, 1.03, 4.90},
    {1000, 4, 0.37, 0.43, 0.46, 1.84, 4.75},
}};

constexpr double kBeyond = 0.0005;  // P(X > largest)
constexpr std::int64_t kNsInAMillisecond = 1'000'000;
constexpr double kNsInAMicrosecond = 1e3;

// X = least + scale (-ln U)^(1/shape), U uniform in (0, 1].
struct Weibull {
  double shape = 1.0, scale = 0.0;
};

// Finds the shape by bisection: (-ln kBeyond)^(1/k) / Gamma(1 + 1/k) = (largest - least) / (mean - least) falls with k.
Weibull weibull_of(const WatersRow& row) {
  const double ratio = (row.largest_us - row.least_us) / (row.mean_us - row.least_us);
  double low = 0.2, high = 50.0;
  for (int step = 0; step < 100; ++step) {
    const double shape = 0.5 * (low + high);
    const double reach = std::pow(-std::log(kBeyond), 1.0 / shape) / std::tgamma(1.0 + 1.0 / shape);
    (reach > ratio ? low : high) = shape;
  }
  return {low, (row.mean_us - row.least_us) / std::tgamma(1.0 + 1.0 / low)};
}

const std::array<Weibull, kWatersRows.size()>& weibulls() {
  static const auto all = [] {
    std::array<Weibull, kWatersRows.size()> found;
    for (std::size_t i = 0; i < found.size(); ++i) found[i] = weibull_of(kWatersRows[i]);
    return found;
  }();
  return all;
}

// Returns the index of a part, drawn by the parts' weights.
template <class Weights> std::size_t draw_part(RandomStream& stream, const Weights& weights) {
  std::int64_t sum = 0;
  for (const int weight : weights) sum += weight;
  std::int64_t left = stream.integer(0, sum - 1);
  std::size_t part = 0;
  while (left >= weights[part]) left -= weights[part++];
  return part;
}

std::size_t draw_row(RandomStream& stream) {
  std::array<int, kWatersRows.size()> shares{};
  for (std::size_t i = 0; i < shares.size(); ++i) shares[i] = kWatersRows[i].share_percent;
  return draw_part(stream, shares);
}

double draw_average_us(RandomStream& stream, const WatersRow& row, const Weibull& weibull) {
  for (;;) {
    const double above = weibull.scale * std::pow(-std::log(1.0 - stream.uniform()), 1.0 / weibull.shape);
    if (row.least_us + above <= row.largest_us) return row.least_us + above;
  }
}

// Removes one element at random, and returns it.
template <class T> T take_one(RandomStream& stream, std::vector<T>& from) {
  const auto at = static_cast<std::ptrdiff_t>(stream.integer(0, static_cast<std::int64_t>(from.size()) - 1));
  const T taken = from[static_cast<std::size_t>(at)];
  from.erase(from.begin() + at);
  return taken;
}

}  // namespace

std::span<const WatersRow> waters_rows() { return kWatersRows; }

WatersTask draw_waters_task(RandomStream& stream) {
  const std::size_t at = draw_row(stream);
  const WatersRow& row = kWatersRows[at];
  const double average_us = draw_average_us(stream, row, weibulls()[at]);
  const double factor = stream.uniform(row.least_factor, row.largest_factor);
  return {.period = row.period_ms * kNsInAMillisecond,
          .average = std::llround(average_us * kNsInAMicrosecond),
          .worst = std::llround(average_us * factor * kNsInAMicrosecond)};
}

WatersMessage draw_waters_message(RandomStream& stream) {
  const std::int64_t period = kWatersRows[draw_row(stream)].period_ms * kNsInAMillisecond;
  return {.period = period, .data_bytes = static_cast<int>(stream.integer(0, 8))};
}

std::vector<WatersTask> draw_waters_tasks(RandomStream& stream, double load, std::size_t most) {
  TTF_CHECK(load > 0.0 && std::isfinite(load), "a load of {}", load);
  std::vector<WatersTask> tasks;
  double sum = 0.0;
  while (tasks.size() < most) {
    const WatersTask task = draw_waters_task(stream);
    sum += static_cast<double>(task.worst) / static_cast<double>(task.period);
    if (sum > load) break;
    tasks.push_back(task);
  }
  return tasks;
}

std::optional<std::vector<std::size_t>> draw_waters_chain(RandomStream& stream, std::span<const std::int64_t> periods) {
  constexpr std::array<int, 3> kDistinct{70, 20, 10};       // percent with 1, 2, 3 periods
  constexpr std::array<int, 4> kInAPeriod{30, 40, 20, 10};  // percent with 2, 3, 4, 5 tasks of a period
  const std::size_t distinct = draw_part(stream, kDistinct) + 1;
  std::vector<std::int64_t> kinds(periods.begin(), periods.end());
  std::sort(kinds.begin(), kinds.end());
  kinds.erase(std::unique(kinds.begin(), kinds.end()), kinds.end());
  if (kinds.size() < distinct) return std::nullopt;
  std::vector<std::size_t> chain;
  for (std::size_t i = 0; i < distinct; ++i) {
    const std::int64_t period = take_one(stream, kinds);
    const std::size_t tasks = draw_part(stream, kInAPeriod) + 2;
    std::vector<std::size_t> open;
    for (std::size_t at = 0; at < periods.size(); ++at)
      if (periods[at] == period) open.push_back(at);
    if (open.size() < tasks) return std::nullopt;
    for (std::size_t n = 0; n < tasks; ++n) chain.push_back(take_one(stream, open));
  }
  return chain;
}

}  // namespace ttf::schedules::timing
