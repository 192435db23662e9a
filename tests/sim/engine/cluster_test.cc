// The time base of a whole cluster in virtual time.
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "sim/engine/cluster_simulation.h"
#include "tests/sim/drives/drive_fixture.h"

namespace ttf::sim::engine {
namespace {

using sim::drives::Drive;

struct PrecisionSink final : recording::records::Sink {
  using recording::records::Sink::on;
  std::vector<recording::records::PrecisionSample> samples;
  void on(const recording::records::PrecisionSample& sample) override { samples.push_back(sample); }
};

// FlexRay 2.1A, as public E-Ray tooling computes it: the schedule was dimensioned for it.
Duration assumed_precision(const schedules::model::GlobalParameters& g) {
  return {((34 + 20 * g.gClusterDriftDamping) * g.gdMaxMicrotick_ps + 2 * g.gdMaxPropagationDelay_ps) / 1000};
}

TEST(TimeBase, StaysWithinTheAssumedPrecisionForDrawnDrifts) {
  Drive drive("scenarios/paper_scenario1.yaml", fusion::strategies::StrategyKind::kAdva);
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    PrecisionSink sink;
    const sim::drives::DriveOutcome outcome = drive.run(sink, seed);
    EXPECT_LT(outcome.precision, assumed_precision(drive.cluster.flexray)) << "seed " << seed;
    EXPECT_GT(outcome.precision, Duration{}) << "clocks that never differ are not measured";
    EXPECT_EQ(outcome.counts.slot_problems, 0u) << "seed " << seed;
    ASSERT_GT(sink.samples.size(), 200u);
  }
}

// Without correction two clocks diverge by the difference of their drifts times the time, until frames leave
// their slots.
TEST(TimeBase, WithoutCorrectionItGrowsAsDriftTimesTime) {
  Drive drive("scenarios/paper_scenario1.yaml", fusion::strategies::StrategyKind::kAdva);
  drive.cluster.synchronisation = false;
  std::int64_t ppb = -20'000;  // -20, -10, 0, 10, 20 ppm: the ends are 40 ppm apart
  for (schedules::model::Node& node : drive.cluster.nodes)
    if (node.flexray) {
      node.drift_ppb = ppb;
      ppb += 10'000;
    }
  PrecisionSink sink;
  drive.run(sink);
  ASSERT_GT(sink.samples.size(), 200u);
  for (const recording::records::PrecisionSample& sample : sink.samples) {
    const double elapsed = (sample.at - kFirstCycle).seconds();
    const double expected_ns = 40e-6 * elapsed * 1e9;
    EXPECT_NEAR(static_cast<double>(sample.precision.ns), expected_ns, 0.01 * expected_ns + 60.0)
        << "at " << elapsed << " s";
  }
  EXPECT_GT(sink.samples.back().precision, Duration::microseconds(100));
}

// With correction the same clocks stay together.
TEST(TimeBase, WithCorrectionTheSameClocksHoldTogether) {
  Drive drive("scenarios/paper_scenario1.yaml", fusion::strategies::StrategyKind::kAdva);
  std::int64_t ppb = -1'500'000;  // the whole range the specification allows
  for (schedules::model::Node& node : drive.cluster.nodes)
    if (node.flexray) {
      node.drift_ppb = ppb;
      ppb += 750'000;
    }
  PrecisionSink sink;
  const sim::drives::DriveOutcome outcome = drive.run(sink);
  EXPECT_LT(outcome.precision, assumed_precision(drive.cluster.flexray));
  EXPECT_EQ(outcome.counts.slot_problems, 0u);
}

}  // namespace
}  // namespace ttf::sim::engine
