// A list is missing, and the fusion node of the shipped clusters goes on. It does so exactly at the first
// fusion instant by which the schedule has the list arrived. Fusion at 1.8 ms + n 10 ms.
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <utility>

#include "nodes/fusion/fusion_host.h"
#include "schedules/analysis/ages.h"
#include "tests/sim/drives/drive_fixture.h"

namespace ttf::sim::drives {
namespace {

using fusion::strategies::StrategyKind;

constexpr GlobalTime at_us(std::int64_t us) { return GlobalTime{} + Duration::microseconds(us); }

struct FusionNode {
  schedules::model::Cluster cluster;
  std::unique_ptr<fusion::strategies::Strategy> strategy;

  FusionNode(const std::string& file, StrategyKind kind)
      : cluster(schedules::file::load_cluster(shipped(file))),
        strategy(fusion::strategies::make_strategy(kind, {}, nodes::fusion::sensor_timings(cluster))) {}
  SensorId sensor(const char* name) const { return *cluster.find_sensor(name); }

  // The instant at which a single list is fused while all other sensors are silent.
  GlobalTime goes_on(const char* name, GlobalTime measured) {
    strategy->accept({{sensor(name), 0}, measured, {}});
    for (GlobalTime now = at_us(1'800);; now += Duration::milliseconds(10)) {
      strategy->fuse(now);
      if (strategy->last_fused()[0].disposition == fusion::strategies::Disposition::kFused) return now;
    }
  }
  Duration worst_delay(const char* name) const {
    for (const schedules::analysis::AgePath& path : schedules::analysis::measurement_ages(cluster))
      if (path.sensor == sensor(name)) return path.fusion_worst;
    return {};
  }
};

// The camera measures at 5.9 ms and its slots end at 41.764 ms, 36 us before the fusion. These 36 us are less
// than the worst delay allows for the clocks of a whole way, but more than two clocks can differ.
TEST(MissingList, TimeTriggeredGoesOnAtTheCamerasDueInstant) {
  FusionNode node("schedules/paper_synchronised.yaml", StrategyKind::kTt);
  EXPECT_EQ(node.goes_on("laser", at_us(27'700)), at_us(41'800));
  EXPECT_GT(at_us(5'900) + node.worst_delay("camera"), at_us(41'800)) << "the delay alone would wait until 51.8 ms";
}

// The laser measures at 27.7 ms and its slots are in the cycle of 80 ms.
TEST(MissingList, TimeTriggeredGoesOnAtTheLasersDueInstant) {
  FusionNode node("schedules/paper_synchronised.yaml", StrategyKind::kTt);
  EXPECT_EQ(node.goes_on("camera", at_us(45'900)), at_us(81'800));
}

// BUFF waits for anything that may have been measured before. The camera's latest way to the gateway takes
// 34.927 ms, clocks and stamp 9 us, and slot 15 begins at 51.176 ms. So a list stamped 16.240 ms is fused at
// 51.8 ms; a younger one may come too late for that.
TEST(MissingList, BuffGoesOnAtTheLastSlotsTheCameraCanReach) {
  for (const auto& [measured_us, fused_us] : {std::pair{16'233, 51'800}, {16'248, 61'800}, {26'225, 61'800}}) {
    FusionNode node("schedules/paper_synchronised.yaml", StrategyKind::kBuff);
    EXPECT_EQ(node.goes_on("laser", at_us(measured_us)), at_us(fused_us)) << measured_us;
  }
  FusionNode node("schedules/paper_synchronised.yaml", StrategyKind::kBuff);
  EXPECT_GT(at_us(16'233) + node.worst_delay("camera"), at_us(51'800)) << "the delay alone would wait until 61.8 ms";
}

}  // namespace
}  // namespace ttf::sim::drives
