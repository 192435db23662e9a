// Drawn tasks, messages and chains have the shares, ranges and means of the tables.
#include "tests/schedules/timing/waters.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <vector>

namespace ttf::schedules::timing {
namespace {

TEST(Waters, TasksHaveTheTablesSharesRangesAndMeans) {
  constexpr int kDraws = 60'000;
  struct Seen {
    int count = 0;
    double sum_us = 0.0, largest_us = 0.0, sum_of_squares = 0.0;
  };
  std::map<std::int64_t, Seen> seen;
  RandomStream stream({.seed = 61});
  for (int draw = 0; draw < kDraws; ++draw) {
    const WatersTask task = draw_waters_task(stream);
    const auto rows = waters_rows();
    const auto row = std::find_if(rows.begin(), rows.end(),
                                  [&](const WatersRow& one) { return one.period_ms * 1'000'000 == task.period; });
    ASSERT_NE(row, rows.end());
    const double us = 1e-3 * static_cast<double>(task.average);
    ASSERT_GE(us, row->least_us - 1e-3);
    ASSERT_LE(us, row->largest_us + 1e-3);
    ASSERT_GE(static_cast<double>(task.worst), row->least_factor * static_cast<double>(task.average) - 40.0);
    ASSERT_LE(static_cast<double>(task.worst), row->largest_factor * static_cast<double>(task.average) + 40.0);
    Seen& one = seen[row->period_ms];
    ++one.count;
    one.sum_us += us;
    one.sum_of_squares += us * us;
    one.largest_us = std::max(one.largest_us, us);
  }
  int shares = 0;
  for (const WatersRow& row : waters_rows()) shares += row.share_percent;
  EXPECT_EQ(shares, 85);
  for (const WatersRow& row : waters_rows()) {
    const Seen& one = seen[row.period_ms];
    const double share = row.share_percent / 85.0, sigma = std::sqrt(share * (1.0 - share) / kDraws);
    EXPECT_NEAR(static_cast<double>(one.count) / kDraws, share, 4.0 * sigma) << row.period_ms;
    // Values beyond the largest are missing, which lowers the mean a little.
    const double mean = one.sum_us / one.count, variance = one.sum_of_squares / one.count - mean * mean;
    EXPECT_NEAR(mean, row.mean_us, 4.0 * std::sqrt(variance / one.count) + 0.001 * (row.largest_us - row.least_us))
        << row.period_ms;
    EXPECT_GT(one.largest_us, row.mean_us + 0.25 * (row.largest_us - row.mean_us)) << row.period_ms;
  }
}

TEST(Waters, SetsStayBelowTheirLoad) {
  RandomStream stream({.seed = 62});
  for (int set = 0; set < 100; ++set) {
    const double load = stream.uniform(0.05, 0.9);
    const std::vector<WatersTask> tasks = draw_waters_tasks(stream, load, 500);
    double sum = 0.0;
    for (const WatersTask& one : tasks) sum += static_cast<double>(one.worst) / static_cast<double>(one.period);
    EXPECT_LE(sum, load);
  }
  EXPECT_EQ(draw_waters_tasks(stream, 1e9, 7).size(), 7U);
}

TEST(Waters, MessagesHaveAllLengths) {
  RandomStream stream({.seed = 63});
  std::set<int> lengths;
  for (int draw = 0; draw < 1'000; ++draw) lengths.insert(draw_waters_message(stream).data_bytes);
  EXPECT_EQ(lengths, (std::set<int>{0, 1, 2, 3, 4, 5, 6, 7, 8}));
}

TEST(Waters, ChainsHaveTheTablesShares) {
  RandomStream stream({.seed = 64});
  std::vector<std::int64_t> periods;
  for (const std::int64_t period : {1, 5, 10, 20})
    for (int task = 0; task < 6; ++task) periods.push_back(period);
  constexpr int kDraws = 20'000;
  std::map<std::size_t, int> distinct;
  std::map<int, int> in_a_period;
  int parts = 0;
  for (int draw = 0; draw < kDraws; ++draw) {
    const auto chain = draw_waters_chain(stream, periods);
    ASSERT_TRUE(chain.has_value());
    EXPECT_EQ(std::set<std::size_t>(chain->begin(), chain->end()).size(), chain->size()) << "no task twice";
    std::map<std::int64_t, int> tasks;
    for (const std::size_t task : *chain) ++tasks[periods[task]];
    ++distinct[tasks.size()];
    for (const auto& [period, count] : tasks) ++in_a_period[count];
    parts += static_cast<int>(tasks.size());
  }
  const auto near = [](int count, int of, double share) {
    EXPECT_NEAR(static_cast<double>(count) / of, share, 4.0 * std::sqrt(share * (1.0 - share) / of));
  };
  near(distinct[1], kDraws, 0.7);
  near(distinct[2], kDraws, 0.2);
  near(distinct[3], kDraws, 0.1);
  near(in_a_period[2], parts, 0.3);
  near(in_a_period[3], parts, 0.4);
  near(in_a_period[4], parts, 0.2);
  near(in_a_period[5], parts, 0.1);
  EXPECT_EQ(draw_waters_chain(stream, std::vector<std::int64_t>{10}), std::nullopt);
}

}  // namespace
}  // namespace ttf::schedules::timing
