// External clock correction: the allowed terms and their instants. A cluster follows a foreign time.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/bus/alone.h"
#include "tests/bus/startup_cluster.h"

namespace ttf::bus::controller {
namespace {

schedules::model::Cluster correctable(schedules::model::Cluster cluster, int damping = 2) {
  for (auto& node : cluster.nodes) {
    node.flexray->pExternOffsetCorrection = 7;
    node.flexray->pExternRateCorrection = 5;
    node.flexray->pClusterDriftDamping = damping;
  }
  return cluster;
}

// Length of a past cycle, in the node's microticks.
std::int64_t length_of(const Reports& reports, std::size_t cycle) {
  return (reports.cycle_starts[cycle + 1].second - reports.cycle_starts[cycle].second).value;
}
std::vector<std::int64_t> lengths(const Reports& reports) {
  std::vector<std::int64_t> all;
  for (std::size_t cycle = 0; cycle + 1 < reports.cycle_starts.size(); ++cycle)
    all.push_back(length_of(reports, cycle));
  return all;
}

TEST(ExternalCorrection, TheOffsetTermIsAddedInOddCycles) {
  for (const auto& [asked, given] : {std::pair{3, 3}, {-2, -2}, {7, 7}, {8, 7}, {-100, -7}, {0, 0}}) {
    Alone node(0, correctable(small_cluster(4)));
    node.controller.set_external_correction(asked, 0);
    node.run_to(6, 100);
    // cycle_starts begins with cycle 1
    EXPECT_EQ(lengths(node.reports),
              (std::vector<std::int64_t>{40'000 + given, 40'000, 40'000 + given, 40'000, 40'000 + given}))
        << asked;
  }
}

TEST(ExternalCorrection, ANodeThatAllowsNoneIsGivenNone) {
  Alone node;
  node.controller.set_external_correction(5, 5);
  node.run_to(6, 100);
  for (const std::int64_t length : lengths(node.reports)) EXPECT_EQ(length, 40'000);
}

// It starts after the static segment of the odd cycle and recurs every double cycle until withdrawn.
TEST(ExternalCorrection, TakesEffectWithTheNextComputation) {
  Alone node(0, correctable(small_cluster(4)));
  node.run_to(1, 839);
  node.controller.set_external_correction(1, 0);
  node.run_to(1, 850);
  node.controller.set_external_correction(2, 0);
  node.run_to(3, 850);
  node.controller.set_external_correction(0, 0);
  node.run_to(8, 100);
  EXPECT_EQ(lengths(node.reports), (std::vector<std::int64_t>{40'001, 40'000, 40'002, 40'000, 40'000, 40'000, 40'000}));
}

// Three sync frames come far too late. The computed offset is limited to 400; the external term is added to
// that.
TEST(ExternalCorrection, TheSumIsNotLimitedAndWhatIsReportedIsWithoutIt) {
  Alone node(0, correctable(small_cluster(4)));
  node.controller.set_external_correction(7, 0);
  node.run_to(1);
  for (const int slot : {2, 3, 4}) {
    Frame frame = Frame::status(slot, 1);
    frame.start += 450;
    frame.arrive(node);
  }
  node.run_to(3, 100);
  ASSERT_EQ(node.reports.corrected.size(), 1u);
  EXPECT_EQ(node.reports.corrected[0].offset.value, 400);
  EXPECT_TRUE(node.reports.corrected[0].offset.limit_reached);
  EXPECT_EQ(length_of(node.reports, 0), 40'407);
}

TEST(ExternalCorrection, TheRateTermStaysWithoutDampingAndAddsUp) {
  Alone node(0, correctable(small_cluster(4), 0));
  node.run_to(1);
  node.controller.set_external_correction(0, 2);
  node.run_to(2, 100);
  EXPECT_EQ(node.controller.clock()->rate_correction(), 2);
  node.run_to(4, 100);
  EXPECT_EQ(node.controller.clock()->rate_correction(), 4);
  node.controller.set_external_correction(0, 0);
  node.run_to(8, 100);
  EXPECT_EQ(node.controller.clock()->rate_correction(), 4);
  node.controller.set_external_correction(0, -9);  // -5
  node.run_to(10, 100);
  EXPECT_EQ(node.controller.clock()->rate_correction(), -1);
}

TEST(ExternalCorrection, DampingTakesTheRateTermBack) {
  Alone node(0, correctable(small_cluster(4), 2));
  node.controller.set_external_correction(0, 5);
  node.run_to(2, 100);
  EXPECT_EQ(node.controller.clock()->rate_correction(), 5);
  node.run_to(4, 100);
  EXPECT_EQ(node.controller.clock()->rate_correction(), 8);
  node.controller.set_external_correction(0, 0);
  for (const int rate : {6, 4, 2, 0, 0}) {
    node.run_to(node.controller.clock()->cycle() + 2, 100);
    EXPECT_EQ(node.controller.clock()->rate_correction(), rate);
  }
}

// Coldstart nodes with terms from power-on use them only in normal operation.
TEST(ExternalCorrection, IsNotForStartup) {
  const auto start = [](int offset) {
    Rig rig(correctable(startup_cluster(3)), {0, 0, 0}, {}, std::vector<TrueTime>(3, Rig::kStart));
    for (std::size_t n = 0; n < 3; ++n) rig.controller(n).set_external_correction(offset, 0);
    rig.run_cycles(60);
    EXPECT_EQ(rig.controller(0).state().kind, poc::PocKind::kNormalActive);
    return rig.reports(0);
  };
  const Reports plain = start(0), given = start(7);
  ASSERT_EQ(plain.cycles, given.cycles);
  ASSERT_EQ(plain.changed.size(), given.changed.size());
  const auto active = std::find_if(plain.changed.begin(), plain.changed.end(),
                                   [](const auto& change) { return change.to == poc::PocKind::kNormalActive; });
  ASSERT_NE(active, plain.changed.end());
  bool later = false;
  for (std::size_t i = 0; i < plain.cycle_starts.size(); ++i) {
    if (plain.cycle_starts[i].second <= active->at) {
      EXPECT_EQ(plain.cycle_starts[i].second, given.cycle_starts[i].second);
    }
    later |= plain.cycle_starts[i].second < given.cycle_starts[i].second;
  }
  EXPECT_TRUE(later);
}

// +1 microtick of 25 ns per double cycle in every node. After 200 of them, all nodes are 5 us behind an
// uncorrected cluster.
TEST(ExternalCorrection, ClustersShiftTogether) {
  constexpr std::int64_t kCycles = 400;
  const TrueTime end = Rig::kStart + Duration::milliseconds(kCycles);
  const std::vector<std::int64_t> drifts{900'000, 300'000, -300'000, -900'000};
  Rig plain(correctable(small_cluster(4)), drifts), shifted(correctable(small_cluster(4)), drifts);
  for (std::size_t n = 0; n < 4; ++n) shifted.controller(n).set_external_correction(1, 0);
  plain.run_until(end);
  shifted.run_until(end);
  EXPECT_LT(shifted.precision(end), kAssumedPrecision);
  for (std::size_t n = 0; n < 4; ++n) {
    const std::int64_t behind = (plain.global_time(n, end) - shifted.global_time(n, end)).ns;
    EXPECT_NEAR(static_cast<double>(behind), 200.0 * 25.0, 300.0) << n;
    EXPECT_TRUE(shifted.reports(n).problems.empty());
  }
}

// A host compares the cluster's time with a reference that runs 20 ppm fast, once per double cycle. It gives
// all controllers the sign of the correction: 7 microticks are 175 ns, the reference gains 40 ns.
TEST(ExternalCorrection, AClusterFollowsAnExternalTime) {
  const auto furthest = [](bool followed) {
    Rig rig(correctable(small_cluster(4)), {50'000, 20'000, -20'000, -50'000});
    double worst = 0.0;
    for (std::int64_t cycle = 2; cycle <= 600; cycle += 2) {
      rig.run_cycles(cycle);
      const TrueTime now = Rig::kStart + Duration::milliseconds(cycle);
      const double reference = static_cast<double>(cycle) * 1e6 * (1.0 + 20e-6);
      const double ahead = static_cast<double>(rig.global_time(0, now).ns) - reference;
      if (followed)
        for (std::size_t n = 0; n < 4; ++n) rig.controller(n).set_external_correction(ahead > 0.0 ? 7 : -7, 0);
      if (cycle > 60) worst = std::max(worst, std::abs(ahead));
    }
    return worst;
  };
  EXPECT_LT(furthest(true), 1'000.0);
  EXPECT_GT(furthest(false), 5'000.0);
}

}  // namespace
}  // namespace ttf::bus::controller
