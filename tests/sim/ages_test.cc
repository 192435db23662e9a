// Ages in simulation against the checker's bounds, over many phases and drifts. That the bounds are reached:
// adverse_ages_test.cc.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "schedules/ages.h"
#include "tests/sim/drive_fixture.h"

namespace ttf {
namespace {

using fusion::StrategyKind;
using testing_support::Drive;
using testing_support::kStrategies;

struct Range {
  Duration best{}, worst{};
  std::size_t count = 0;
  void add(Duration age) {
    best = count == 0 ? age : std::min(best, age);
    worst = count == 0 ? age : std::max(worst, age);
    ++count;
  }
};

// When fused: of every list. When used: of the newest measurement of each sensor in the used image, at every use.
struct Ages final : records::Sink {
  using records::Sink::on;
  std::map<SensorId, Range> fused, used;
  std::size_t uses_without_image = 0;

  void on(const records::ListFused& list) override {
    if (list.disposition != records::Disposition::kFused && list.disposition != records::Disposition::kFusedLate) return;
    fused[list.id.sensor].add(list.stamp.global - list.measured);
    measured_[list.id] = list.measured;
  }
  void on(const records::ImageWritten& image) override {
    newest_[image.sequence].assign(image.newest.begin(), image.newest.end());
  }
  void on(const records::FeatureUsed& use) override {
    const auto image = newest_.find(use.image_sequence);
    if (image == newest_.end()) ++uses_without_image;
    else
      for (const MeasurementId& id : image->second) used[id.sensor].add(use.stamp.global - measured_.at(id));
  }
  // Drives count their images and measurements from 0 again.
  void next_drive() {
    measured_.clear();
    newest_.clear();
  }

 private:
  std::map<MeasurementId, GlobalTime> measured_;
  std::map<std::uint32_t, std::vector<MeasurementId>> newest_;
};

TEST(Ages, SimulatedAgesLieWithinTheBounds) {
  for (const StrategyKind strategy : kStrategies) {
    const Drive drive("scenarios/paper_scenario1.yaml", strategy);
    Ages ages;
    constexpr std::uint64_t kDrives = 40;
    for (std::uint64_t seed = 1; seed <= kDrives; ++seed) {
      drive.run(ages, seed);
      ages.next_drive();
    }
    EXPECT_EQ(ages.uses_without_image, 0u);
    const bool buffered = strategy == StrategyKind::kBuff;
    const auto paths = schedules::measurement_ages(drive.cluster);
    ASSERT_EQ(paths.size(), 2u);
    for (const schedules::AgePath& path : paths) {
      SCOPED_TRACE(std::string(nodes::name_of(strategy)) + ", " + drive.cluster.sensor(path.sensor).name);
      const Range &fused = ages.fused[path.sensor], &used = ages.used[path.sensor];
      EXPECT_GT(fused.count, kDrives * 30);
      EXPECT_GE(fused.best, path.fused_best);
      EXPECT_LE(fused.worst, buffered ? path.buffered_fused_worst : path.fused_worst);
      ASSERT_TRUE(path.reaches_use);
      EXPECT_GT(used.count, kDrives * 60);
      EXPECT_GE(used.best, path.use_best);
      EXPECT_LE(used.worst, buffered ? path.buffered_newest_worst : path.newest_worst);
      // The bound is no empty promise: over so many phases the worst age comes within a fusion period and a use's.
      EXPECT_GT(used.worst, (buffered ? path.buffered_newest_worst : path.newest_worst) - Duration::milliseconds(50));
    }
  }
}

}  // namespace
}  // namespace ttf
