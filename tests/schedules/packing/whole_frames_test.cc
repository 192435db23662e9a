// The theorem of whole frames (first_fit.h), against exhaustive search and its closed form.
#include <gtest/gtest.h>

#include <numeric>

#include "schedules/packing/first_fit.h"
#include "schedules/packing/lower_bound.h"
#include "schedules/packing/orders.h"
#include "tests/schedules/packing/exhaustive.h"

namespace ttf::schedules::packing {
namespace {

constexpr int kTinyCycles = 8;

// Whole frames of one bit: `counts[k]` of repetition 2^k. Node `i % nodes` sends the i-th.
Instance whole_frames(const std::vector<int>& counts, int nodes, bool shared) {
  Instance instance{std::vector<std::string>(static_cast<std::size_t>(nodes)), {}, 1, kTinyCycles, shared};
  // Long periods first, so that the order of the file is not the ascending one.
  for (std::size_t k = counts.size(); k-- > 0;)
    for (int i = 0; i < counts[k]; ++i) {
      const int repetition = 1 << k;
      const int node = static_cast<int>(instance.signals.size()) % nodes;
      instance.signals.push_back({std::to_string(i), node, repetition, {0, repetition - 1}, 1});
    }
  return instance;
}

Order ascending(const Instance& instance, Order order) {
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return instance.signals[a].repetition < instance.signals[b].repetition;
  });
  return order;
}

int bins_of(const Instance& instance, const Order& order, Fit fit) {
  Packed packed{{}, Places(instance.signals.size())};
  first_fit(instance, order, fit, packed);
  return static_cast<int>(packed.bins.size());
}

int rounded_up_share(const Instance& instance) {
  int cycles = 0;
  for (const Signal& signal : instance.signals) cycles += kTinyCycles / signal.repetition;
  return (cycles + kTinyCycles - 1) / kTinyCycles;
}

template <class On> void each_small_count(On&& on) {
  for (int a = 0; a <= 1; ++a)
    for (int b = 0; b <= 3; ++b)
      for (int c = 0; c <= 3; ++c)
        for (int d = 0; d <= 4; ++d) on(std::vector<int>{a, b, c, d});
}

TEST(WholeFrames, AscendingFirstFitIsOptimalForANode) {
  each_small_count([](const std::vector<int>& counts) {
    const Instance instance = whole_frames(counts, 1, false);
    const Order order = possible_signals(instance);
    const int closed_form = rounded_up_share(instance);
    for (const Fit fit : {Fit::kLowestCycle, Fit::kLowestBit})
      EXPECT_EQ(bins_of(instance, ascending(instance, order), fit), closed_form) << ::testing::PrintToString(counts);
    EXPECT_EQ(least_bins(instance, order), closed_form);
    if (instance.signals.size() <= 6) {
      EXPECT_EQ(fewest_bins(instance), closed_form);
    }
  });
}

TEST(WholeFrames, AscendingFirstFitIsOptimalForAllNodesThatShareSlots) {
  each_small_count([](const std::vector<int>& counts) {
    const Instance instance = whole_frames(counts, 3, true);
    const Order order = possible_signals(instance);
    const int closed_form = rounded_up_share(instance);
    EXPECT_EQ(bins_of(instance, ascending(instance, order), Fit::kLowestCycle), closed_form);
    EXPECT_EQ(least_bins(instance, order), closed_form);
    if (instance.signals.size() <= 6) {
      EXPECT_EQ(fewest_bins(instance), closed_form);
    }
  });
}

TEST(WholeFrames, AnotherOrderNeedsMore) {
  // Two frames of every 2nd cycle between those of every 8th: each of these opens a half that no slow one fills.
  Instance instance = whole_frames({0, 2, 0, 2}, 1, false);
  for (Signal& signal : instance.signals) signal.window = {0, signal.repetition - 1};
  const Order slow_first = possible_signals(instance);  // 8, 8, 2, 2: cycles 0 and 1, so neither half is free
  EXPECT_EQ(bins_of(instance, slow_first, Fit::kLowestCycle), 2);
  EXPECT_EQ(bins_of(instance, ascending(instance, slow_first), Fit::kLowestCycle), 2);
  instance = whole_frames({0, 1, 0, 2}, 1, false);
  const Order slow = possible_signals(instance);
  EXPECT_EQ(bins_of(instance, slow, Fit::kLowestCycle), 2);
  EXPECT_EQ(bins_of(instance, ascending(instance, slow), Fit::kLowestCycle), 1);
}

TEST(WholeFrames, SignalsOfOneLengthThatDividesThePayloadAreLikeWholeFrames) {
  for (const int length : {1, 2, 4}) {
    Instance instance = whole_frames({1, 3, 5, 9}, 1, false);
    instance.payload_bits = 4;
    for (Signal& signal : instance.signals) signal.bits = length;
    const Order order = possible_signals(instance);
    const int cycles = (8 + 3 * 4 + 5 * 2 + 9) * length;
    const int closed_form = (cycles + 8 * 4 - 1) / (8 * 4);
    for (const Fit fit : {Fit::kLowestCycle, Fit::kLowestBit})
      EXPECT_EQ(bins_of(instance, ascending(instance, order), fit), closed_form);
    EXPECT_EQ(least_bins(instance, order), closed_form);
  }
}

}  // namespace
}  // namespace ttf::schedules::packing
