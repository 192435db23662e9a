// Durations counted in bins have the sorted list's quantiles, to a bin. The reports of a node's processes are
// summed.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/random.h"
#include "recording/exports/lateness_sums.h"
#include "recording/records/binned_durations.h"

namespace ttf::recording::exports {
namespace {

using records::BinnedDurations;
using records::kLatenessBins;

Duration us(std::int64_t n) { return Duration::microseconds(n); }

// The bins tile the axis: each begins at the end of the one before, and contains everything between.
TEST(LatenessBins, EveryDurationIsInTheBinThatBeginsBeforeIt) {
  for (std::size_t bin = 0; bin + 1 < kLatenessBins; ++bin) {
    const Duration from = records::lateness_from(bin), to = records::lateness_from(bin + 1);
    ASSERT_LT(from, to) << bin;
    EXPECT_EQ(records::lateness_bin(from), bin);
    EXPECT_EQ(records::lateness_bin(to - Duration{1}), bin);
    EXPECT_LE((to - from).ns, std::max<std::int64_t>(1000, from.ns / 32)) << bin;
  }
  EXPECT_EQ(records::lateness_bin(Duration{-1}), 0u);
  EXPECT_EQ(records::lateness_bin(us(67'000'000)), kLatenessBins - 1);
  EXPECT_EQ(records::lateness_bin(Duration{std::numeric_limits<std::int64_t>::max()}), kLatenessBins - 1);
}

// The oracle: the sorted list's, nearest rank.
Duration nearest_rank(std::vector<Duration> list, int thousandths) {
  std::sort(list.begin(), list.end());
  const std::size_t rank = (list.size() * static_cast<std::size_t>(thousandths) + 999) / 1000;
  return list[std::max<std::size_t>(rank, 1) - 1];
}

TEST(BinnedDurations, QuantilesAreTheSortedListsToABin) {
  RandomStream stream({.seed = 1, .purpose = Purpose::kTest});
  for (const std::int64_t count : {1, 2, 3, 10, 99, 100, 101, 1000, 5000}) {
    std::vector<Duration> list;
    BinnedDurations binned;
    for (std::int64_t i = 0; i < count; ++i) {
      // From early by microseconds to late by seconds, most of it near 60 us.
      const double late_us = 60.0 * std::exp(2.0 * stream.normal()) - 5.0;
      list.push_back(Duration{static_cast<std::int64_t>(late_us * 1000.0)});
      binned.add(list.back());
    }
    EXPECT_EQ(binned.count(), static_cast<std::uint64_t>(count));
    EXPECT_EQ(binned.longest(), *std::max_element(list.begin(), list.end()));
    for (const int thousandths : {0, 1, 500, 750, 990, 999, 1000}) {
      const Duration exact = nearest_rank(list, thousandths), found = binned.quantile(thousandths);
      EXPECT_GE(found, exact) << count << " " << thousandths;
      EXPECT_LE(found.ns, std::max<std::int64_t>(exact.ns, 0) + std::max<std::int64_t>(1000, exact.ns / 32))
          << count << " " << thousandths;
    }
  }
}

TEST(BinnedDurations, KnownAnswers) {
  BinnedDurations binned;
  EXPECT_TRUE(binned.empty());
  EXPECT_EQ(binned.quantile(500), Duration{});
  EXPECT_EQ(binned.longest(), Duration{});
  binned.add(Duration{-3000});
  EXPECT_EQ(binned.longest(), Duration{-3000}) << "all were early";
  EXPECT_EQ(binned.quantile(500), Duration{-3000});
  for (int i = 0; i < 8; ++i) binned.add(us(10));
  binned.add(us(40));
  // -3, eight times 10, 40: the first of ten is early, nine are late by 10 us or more.
  EXPECT_EQ(binned.count(), 10u);
  EXPECT_EQ(binned.count_from(1), 9u);
  EXPECT_EQ(binned.count_from(10), 9u);
  EXPECT_EQ(binned.count_from(11), 1u);
  EXPECT_EQ(binned.quantile(100), us(1));
  EXPECT_EQ(binned.quantile(101), us(11));
  EXPECT_EQ(binned.quantile(900), us(11));
  EXPECT_EQ(binned.quantile(901), us(40)) << "not beyond the longest";
  ASSERT_EQ(binned.counts().size(), 41u) << "to the last that is not empty";
  const BinnedDurations again(binned.counts(), binned.longest());
  EXPECT_EQ(again.count(), 10u);
  EXPECT_EQ(again.quantile(900), us(11));
}

TEST(BinnedDurations, NumbersThatDoNotFitAreTheLargest) {
  const std::vector<std::uint64_t> counts(kLatenessBins + 7, std::numeric_limits<std::uint64_t>::max());
  BinnedDurations binned(counts, us(5));
  binned.add(us(3));
  binned.add(binned);
  EXPECT_EQ(binned.count(), std::numeric_limits<std::uint64_t>::max());
  EXPECT_EQ(binned.quantile(500), us(1));
}

// Histograms of one node: (local time, counts, longest).
struct Reported {
  std::int64_t local_us;
  std::vector<std::uint64_t> counts;
  std::int64_t longest_us;
};
records::BinnedDurations wake_ups_of(const std::vector<Reported>& all) {
  LatenessSums sums;
  for (const Reported& reported : all)
    sums.on(records::LatenessHistogram{{{}, LocalTime{reported.local_us * 1000}, {}, NodeId{4}},
                                       records::LatenessOf::kWakeUps,
                                       us(reported.longest_us),
                                       reported.counts});
  return sums.nodes()[NodeId{4}].wake_ups;
}

TEST(LatenessSums, TheNewestHistogramHoldsAllBeforeIt) {
  const auto wake_ups = wake_ups_of({{100, {5, 2}, 1}, {200, {5, 4, 1}, 2}, {300, {9, 4, 1}, 2}});
  EXPECT_EQ(wake_ups.count(), 14u);
  EXPECT_EQ(wake_ups.longest(), us(2));
}

TEST(LatenessSums, AnotherProcessOfTheNodeIsAdded) {
  // A bin with less than before; fewer bins; or the clock began again.
  for (const Reported& second : {Reported{200, {7, 1, 1}, 2}, Reported{200, {9}, 0}, Reported{50, {5, 2, 9}, 2}}) {
    const auto wake_ups = wake_ups_of({{100, {5, 2}, 1}, second});
    std::uint64_t of_second = 0;
    for (const std::uint64_t count : second.counts) of_second += count;
    EXPECT_EQ(wake_ups.count(), 7 + of_second);
    EXPECT_EQ(wake_ups.longest(), us(std::max<std::int64_t>(1, second.longest_us)));
  }
}

TEST(LatenessSums, NodesAndWhatItIsOfAreKeptApart) {
  LatenessSums sums;
  EXPECT_TRUE(sums.nodes().empty());
  for (std::uint8_t node = 0; node < 3; ++node)
    for (std::uint8_t of = 1; of <= index_of(records::LatenessOf::kTransits); ++of) {
      const std::vector<std::uint64_t> counts{10u * node + of};
      sums.on(records::LatenessHistogram{{{}, {}, {}, NodeId{node}}, records::LatenessOf{of}, us(of), counts});
    }
  const auto nodes = sums.nodes();
  ASSERT_EQ(nodes.size(), 3u);
  EXPECT_EQ(nodes.at(NodeId{2}).wake_ups.count(), 21u);
  EXPECT_EQ(nodes.at(NodeId{2}).floor.count(), 22u);
  EXPECT_EQ(nodes.at(NodeId{1}).departures.count(), 13u);
  EXPECT_EQ(nodes.at(NodeId{0}).arrivals.count(), 4u);
  EXPECT_EQ(nodes.at(NodeId{0}).arrivals.longest(), us(4));
  EXPECT_EQ(nodes.at(NodeId{1}).transits.count(), 15u);
}

}  // namespace
}  // namespace ttf::recording::exports
