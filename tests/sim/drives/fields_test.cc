// The tracker has the field of each sensor, in whole clusters: cars that one sensor alone sees, and one that a lorry hides.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>
#include <tuple>

#include "sim/drives/known_fields.h"
#include "tests/sim/drives/drive_fixture.h"

namespace ttf::sim::drives {
namespace {

using fusion::config::Birth;
using fusion::strategies::StrategyKind;

class SeenByOne : public testing::TestWithParam<std::tuple<StrategyKind, Birth>> {
 protected:
  SeenByOne() {
    drive_.scenario.world.acceleration_noise = drive_.scenario.world.yaw_rate_noise = 0.0;
    drive_.scenario.tracker.birth = std::get<1>(GetParam());
    stand(20.0, 17.0);
  }
  sim::world::ObjectConfig& stand(double x, double y) {
    sim::world::ObjectConfig& car = drive_.scenario.world.objects[0];
    car.x = x, car.y = y, car.heading = car.speed = 0.0;
    car.segments.clear();
    return car;
  }
  // A lorry stands ahead, and the car drives past behind it.
  void pass_behind_a_lorry() {
    sim::world::ObjectConfig& car = stand(45.0, -24.0);
    car.heading = 1.5707963267948966;
    car.speed = 12.0;
    sim::world::ObjectConfig lorry = car;
    lorry.name = "lorry";
    lorry.x = 15.0, lorry.y = 0.0, lorry.heading = lorry.speed = 0.0;
    lorry.length = 10.0, lorry.width = 2.5;
    lorry.reference = false;
    drive_.scenario.world.objects.push_back(lorry);
    drive_.scenario.sensors.of<sensors::stereo_camera::Kind>().usual.model.clutter_per_frame = 0.0;
    drive_.scenario.duration = Duration::milliseconds(3500);
  }
  // Counts uses of images that do not show the object, in view or not.
  static std::uint64_t not_shown(const evaluation::accuracy::DriveSummary& sum) {
    return sum.missed + sum.out_of_view - sum.shown_out_of_view;
  }
  evaluation::accuracy::DriveSummary summary() const {
    evaluation::accuracy::DriveMeasures measures(evaluation_start(drive_.scenario));
    drive_.run(measures);
    return measures.finish();
  }

  Drive drive_{"scenarios/paper_scenario1.yaml", std::get<0>(GetParam())};
};
INSTANTIATE_TEST_SUITE_P(All, SeenByOne,
                         testing::Combine(testing::ValuesIn(fusion::strategies::kAllStrategies),
                                          testing::Values(Birth::kMOfN, Birth::kExistence)),
                         [](const auto& way) {
                           return std::string(name_of(std::get<0>(way.param))) +
                                  (std::get<1>(way.param) == Birth::kMOfN ? "MOfN" : "Existence");
                         });

// 40 degrees aside: inside the laser's field, outside of the camera's.
TEST_P(SeenByOne, TheLaserAloneIsEnough) {
  const evaluation::accuracy::DriveSummary sum = summary();
  EXPECT_EQ(sum.matched, 37u);
  EXPECT_EQ(sum.missed, 0u);
  EXPECT_EQ(sum.spurious, 0u);
}

// Straight ahead, where the laser's range ends before the car.
TEST_P(SeenByOne, TheCameraAloneIsEnough) {
  drive_.scenario.sensors.of<sensors::laser::Kind>().usual.model.max_range_m = 25.0;
  stand(40.0, 0.0);
  const evaluation::accuracy::DriveSummary sum = summary();
  EXPECT_EQ(sum.matched, 37u);
  EXPECT_EQ(sum.missed, 0u);
}

// A camera that is said to see all around is as without this knowledge: M of N counts the camera's empty lists.
TEST_P(SeenByOne, AStatedFieldCountsMoreThanTheScenarios) {
  drive_.scenario.tracker.sensors.resize(1);
  drive_.scenario.tracker.sensors[0].name = "camera";
  drive_.scenario.tracker.sensors[0].field = fusion::sensors::Field{};
  const fusion::config::TrackerConfig tracker = tracker_of(drive_.scenario, drive_.cluster);
  for (std::size_t s = 0; s < tracker.sensors.size(); ++s) {
    ASSERT_TRUE(tracker.sensors[s].field.has_value());
    EXPECT_EQ(tracker.sensors[s].field->all_around(), drive_.cluster.sensors[s].name == "camera");
  }
  if (std::get<1>(GetParam()) == Birth::kMOfN) {
    EXPECT_EQ(summary().matched, 0u);
  }
}

// The identities of far tracks at uses.
struct Identities final : recording::records::Sink {
  using recording::records::Sink::on;
  TrueTime from{};
  double farther_than = 0.0;  // [m]
  std::multiset<TrackId> tracks;
  int uses = 0;
  void on(const recording::records::FeatureUsed& used) override {
    if (used.stamp.true_time < from) return;
    ++uses;
    for (const auto& object : used.objects)
      if (object.image.x > farther_than) tracks.insert(object.image.track);
  }
};

TEST_P(SeenByOne, ACarBehindALorryIsKept) {
  pass_behind_a_lorry();
  const evaluation::accuracy::DriveSummary sum = summary();
  EXPECT_EQ(not_shown(sum), 0u);
  EXPECT_GT(sum.out_of_view, 5u) << "it is hidden";
  // Hidden, it keeps its track. As it emerges, its front may begin one of its own, which may outlive the first.
  Identities identities;
  identities.from = evaluation_start(drive_.scenario);
  identities.farther_than = 35.0;
  drive_.run(identities);
  std::size_t longest = 0;
  for (const TrackId track : identities.tracks) longest = std::max(longest, identities.tracks.count(track));
  EXPECT_GT(longest, 30u) << "of " << identities.uses;
}

// Both sensors count against the hidden car.
TEST_P(SeenByOne, WithoutShadowsACarBehindALorryIsLost) {
  pass_behind_a_lorry();
  drive_.scenario.tracker.sensors.resize(2);
  for (std::size_t s = 0; s < 2; ++s) {
    drive_.scenario.tracker.sensors[s].name = drive_.cluster.sensors[s].name;
    drive_.scenario.tracker.sensors[s].field = fusion::sensors::Field{.shadow = 0.0};
  }
  EXPECT_GT(not_shown(summary()), 10u);
}

TEST(KnownFields, OfARecordedSensorOnlyAStatedOne) {
  Drive drive("scenarios/laser_radar_recorded.yaml", StrategyKind::kAdva);
  for (const fusion::sensors::KnownSensor& sensor : tracker_of(drive.scenario, drive.cluster).sensors)
    EXPECT_FALSE(sensor.field.has_value());
  drive.scenario.tracker.sensors.resize(1);
  drive.scenario.tracker.sensors[0].name = drive.cluster.sensors[0].name;
  drive.scenario.tracker.sensors[0].field = fusion::sensors::Field{.half_angle = 0.5};
  EXPECT_EQ(tracker_of(drive.scenario, drive.cluster).sensors[0].field->half_angle, 0.5);
}

}  // namespace
}  // namespace ttf::sim::drives
