// No cyclic path allocates: controllers, tasks, strategies, the media between them, and the world. A run
// allocates at its start, sized by schedule and scenario. There is no warm-up: the first cycle's memory is
// enough for all.
#include <gtest/gtest.h>

#include <algorithm>
#include <optional>

#include "tests/sim/drives/drive_fixture.h"
#include "tests/support/allocation_counter.h"

namespace ttf::sim::drives {
namespace {

// Reads the counter at the first record of the run and at every end of a task.
struct AllocationsSeen final : recording::records::Sink {
  using recording::records::Sink::on;
  std::optional<std::int64_t> at_start;
  std::int64_t last = 0;
  TrueTime first_more{};  // where a failure is to be looked for
  int fusions = 0, uses = 0;
  std::size_t most_hits = 0;

  void on(const recording::records::SlotFrameSent&) override { read({}); }
  void on(const recording::records::TaskRun& run) override { read(run.end.true_time); }
  void on(const recording::records::FusionStep&) override { ++fusions; }
  void on(const recording::records::FeatureUsed&) override { ++uses; }
  void on(const recording::records::Measured& measured) override {
    most_hits = std::max(most_hits, measured.truth_ids.size());
  }

 private:
  void read(TrueTime at) {
    last = support::allocations();
    if (!at_start) at_start = last;
    if (last != *at_start && first_more == TrueTime{}) first_more = at;
  }
};

class Allocations : public testing::TestWithParam<fusion::strategies::StrategyKind> {
 protected:
  AllocationsSeen expect_none(const Drive& drive, int fusions) const {
    AllocationsSeen seen;
    drive.run(seen);
    EXPECT_GE(seen.fusions, fusions);
    EXPECT_GE(seen.uses, fusions / 4 - 1);
    EXPECT_EQ(seen.last - *seen.at_start, 0) << "the first at " << seen.first_more.ns << " ns";
    return seen;
  }
};

TEST_P(Allocations, NoneInThePapersDrives) {
  expect_none(Drive("scenarios/paper_scenario1.yaml", GetParam()), 290);
  expect_none(Drive("scenarios/paper_scenario2.yaml", GetParam()), 290);
}

TEST_P(Allocations, NoneWithRadars) { expect_none(Drive("scenarios/laser_and_radar.yaml", GetParam()), 590); }

TEST_P(Allocations, NoneWithACrowd) {
  Drive drive("scenarios/crowd_25.yaml", GetParam());
  drive.scenario.duration = Duration::milliseconds(12'000);
  expect_none(drive, 1'190);
}

TEST_P(Allocations, NoneOnAVehicleThatDrives) { expect_none(Drive("scenarios/turning_ego.yaml", GetParam()), 415); }

// The longest lists. Each of the laser's beams hits one of two fences, whose gaps cut the scan into many
// segments. More is seen than the observation lists and the image carry.
TEST_P(Allocations, NoneWithFullLists) {
  Drive drive("scenarios/paper_scenario1.yaml", GetParam());
  drive.scenario.world.objects.clear();
  for (int row = 0; row < 2; ++row)
    for (int post = -40; post <= 40; ++post) {
      sim::world::ObjectConfig object;
      object.x = 20.0 + 8.0 * row;
      object.y = 1.6 * post + 0.8 * row;
      object.heading = 1.5707963;
      object.length = 1.2;
      object.width = 0.4;
      drive.scenario.world.objects.push_back(object);
    }
  drive.scenario.sensors.of<sensors::laser::Kind>().usual.model.half_field_rad = 0.7;
  const AllocationsSeen seen = expect_none(drive, 290);
  EXPECT_GT(seen.most_hits, 1'200u);
}

INSTANTIATE_TEST_SUITE_P(Strategies, Allocations, testing::ValuesIn(fusion::strategies::kAllStrategies),
                         [](const auto& strategy) { return std::string(name_of(strategy.param)); });

}  // namespace
}  // namespace ttf::sim::drives
