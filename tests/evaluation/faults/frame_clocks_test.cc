// The clocks' distance as their frames show it.
#include "evaluation/faults/frame_clocks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "tests/sim/drives/living_drive.h"

namespace ttf::evaluation::faults {
namespace {

using fusion::strategies::StrategyKind;
using sim::drives::LivingDrive;

// The clocks' distance from frames, against the simulator's own, which covers a whole double cycle.
struct Spread final : recording::records::Sink {
  using recording::records::Sink::on;
  const schedules::model::Cluster& cluster;
  FrameClocks clocks;
  Duration since_sample{};
  std::vector<std::pair<Duration, Duration>> reported_and_true;
  explicit Spread(const schedules::model::Cluster& c) : cluster(c), clocks(c) {}
  void on(const recording::records::SlotFrameSent& frame) override {
    if (const auto apart = clocks.sent(frame)) since_sample = std::max(since_sample, *apart);
  }
  void on(const recording::records::PrecisionSample& sample) override {
    reported_and_true.emplace_back(since_sample, sample.precision);
    since_sample = {};
  }
};

TEST(FrameClocks, MeasureTheDistanceOfTheClocks) {
  const auto cluster = schedules::file::load_cluster(sim::drives::shipped("schedules/paper_synchronised.yaml"));
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    Spread spread(cluster);
    LivingDrive drive(StrategyKind::kTt, &spread, seed);
    drive.run_to(2.0);
    ASSERT_GT(spread.reported_and_true.size(), 100u);
    for (std::size_t i = 5; i < spread.reported_and_true.size(); ++i) {
      const auto& [reported, truth] = spread.reported_and_true[i];
      EXPECT_LE(reported, truth + Duration::nanoseconds(30)) << "seed " << seed << " double cycle " << i;
      EXPECT_GE(reported.ns, truth.ns / 2 - 60) << "seed " << seed << " double cycle " << i;
    }
  }
}

}  // namespace
}  // namespace ttf::evaluation::faults
