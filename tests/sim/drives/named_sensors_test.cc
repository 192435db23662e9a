// Two lasers and a camera, each with its own place, noise and errors, in whole drives.
#include <gtest/gtest.h>

#include <cmath>
#include <tuple>
#include <utility>
#include <vector>

#include "evaluation/accuracy/drive_measures.h"
#include "tests/sim/drives/drive_fixture.h"

namespace ttf::sim::drives {
namespace {

using fusion::strategies::StrategyKind;
using Laser = sensors::kinds::SensorEntry<sensors::laser::Kind>;

// The sightings of each sensor, in the vehicle's axes, as the fusion node takes them.
struct Sightings final : recording::records::Sink {
  using recording::records::Sink::on;
  using Sighting = std::tuple<std::uint32_t, double, double, double>;  // list, x, y, variance of x
  std::vector<Sighting> of[3];
  void on(const recording::records::ObservationSeen& seen) override {
    of[index_of(seen.id.sensor)].push_back({seen.id.sequence, seen.x, seen.y, seen.sxx});
  }
};

class TwoLasers : public testing::TestWithParam<StrategyKind> {
 protected:
  enum : std::size_t { kLeft, kRight, kCamera };

  TwoLasers() {
    drive_.scenario.world.acceleration_noise = drive_.scenario.world.yaw_rate_noise = 0.0;
    sim::world::ObjectConfig& car = drive_.scenario.world.objects[0];
    car.x = 25.0, car.y = 0.0, car.heading = 0.0, car.speed = 0.0;
  }

  double car_length() const { return drive_.scenario.world.objects[0].length; }
  Laser& laser(std::size_t which) { return drive_.scenario.sensors.of<sensors::laser::Kind>().own.at(which); }
  Sightings sightings() const {
    Sightings seen;
    drive_.run(seen);
    return seen;
  }
  static double mean(const std::vector<Sightings::Sighting>& all, std::size_t axis) {
    double sum = 0.0;
    for (const auto& [list, x, y, sxx] : all) sum += axis == 0 ? x : y;
    return sum / static_cast<double>(all.size());
  }

  Drive drive_{"scenarios/two_lasers.yaml", GetParam()};
};

TEST_P(TwoLasers, EachSeesTheCarFromItsOwnPlace) {
  const Sightings seen = sightings();
  for (const std::size_t sensor : {kLeft, kRight}) {
    EXPECT_GE(seen.of[sensor].size(), 30u);
    EXPECT_NEAR(mean(seen.of[sensor], 0), 25.0 - 0.5 * car_length(), 0.3) << sensor << ", which sees the rear";
    EXPECT_NEAR(mean(seen.of[sensor], 1), 0.0, 0.3) << sensor;
  }
  EXPECT_NE(seen.of[kLeft], seen.of[kRight]);
  // The tracker still takes the left laser to be where it was.
  laser(kLeft).model.device.placement.y += 2.0;
  const Sightings moved = sightings();
  // It sees the corner of rear and side, the other way.
  EXPECT_GT(std::abs(mean(moved.of[kLeft], 1) - mean(seen.of[kLeft], 1)), 0.9);
  EXPECT_EQ(moved.of[kRight], seen.of[kRight]);
  EXPECT_EQ(moved.of[kCamera], seen.of[kCamera]);
}

TEST_P(TwoLasers, ABiasIsInTheListsOfItsSensorAlone) {
  const Sightings right = sightings();
  laser(kLeft).model.range_bias.fixed = 1.0;
  const Sightings biased = sightings();
  EXPECT_NEAR(mean(biased.of[kLeft], 0) - mean(right.of[kLeft], 0), 1.0, 0.1);
  EXPECT_EQ(biased.of[kRight], right.of[kRight]);
  EXPECT_EQ(biased.of[kCamera], right.of[kCamera]);
}

TEST_P(TwoLasers, NoiseAndPreprocessingAreItsOwn) {
  const Sightings before = sightings();
  laser(kRight).model.range_sigma_m = 0.4;
  const Sightings noisy = sightings();
  EXPECT_NE(noisy.of[kRight], before.of[kRight]);
  EXPECT_EQ(noisy.of[kLeft], before.of[kLeft]);
  laser(kRight).preprocessing->rectangle.range_noise_m = 0.4;
  const Sightings known = sightings();
  // One without its own noise takes some of these cars for something rough.
  EXPECT_GT(known.of[kRight].size(), noisy.of[kRight].size());
  // A fit that leaves more than the stated noise says so by itself, so both exceed that of the quiet laser.
  EXPECT_NE(known.of[kRight], noisy.of[kRight]);
  EXPECT_GT(std::get<3>(known.of[kRight].front()), std::get<3>(before.of[kRight].front()));
  EXPECT_EQ(known.of[kLeft], before.of[kLeft]);
  EXPECT_EQ(known.of[kCamera], before.of[kCamera]);
}

INSTANTIATE_TEST_SUITE_P(EveryStrategy, TwoLasers, testing::ValuesIn(fusion::strategies::kAllStrategies),
                         [](const auto& one) { return std::string(name_of(one.param)); });

TEST(ShippedTwoLasers, AreTrackedByEveryStrategy) {
  for (const StrategyKind strategy : fusion::strategies::kAllStrategies) {
    const Drive drive("scenarios/two_lasers.yaml", strategy);
    check_fits(drive.scenario, drive.cluster, strategy, false);
    evaluation::accuracy::DriveMeasures measures(evaluation_start(drive.scenario));
    drive.run(measures);
    const evaluation::accuracy::DriveSummary summary = measures.finish();
    EXPECT_LT(summary.position_rmse_truth, 0.4) << name_of(strategy);
    EXPECT_GT(summary.matched, 40u) << name_of(strategy);
    EXPECT_EQ(summary.missed, 0u) << name_of(strategy);
    EXPECT_EQ(summary.age_fused_by_sensor.size(), 3u) << name_of(strategy);
  }
}

// Two cameras with one lens have the same host. Marks are of the camera whose pictures they come from.
TEST(LaneKeepingWithTwoCameras, TakesItsOwnCamerasDistance) {
  struct Steering final : recording::records::Sink {
    double angle = 0.0;
    using Sink::on;
    void on(const recording::records::CommandIssued& command) override {
      EXPECT_TRUE(command.valid);
      angle = command.steering;
    }
  };
  const auto steering = [](double own_m, double other_m) {
    Drive drive("scenarios/lane_keeping.yaml", StrategyKind::kTt);
    schedules::model::Cluster& cluster = drive.cluster;
    schedules::model::Sensor other = cluster.sensor(*cluster.find_sensor("mono_camera"));
    other.name = "other_camera";
    cluster.sensors.push_back(other);
    auto& cameras = drive.scenario.sensors.of<sensors::mono_camera::Kind>();
    cameras.own.clear();
    for (const auto& [name, ahead_m] : {std::pair{"mono_camera", own_m}, std::pair{"other_camera", other_m}}) {
      cameras.own.push_back(cameras.usual);
      cameras.own.back().name = name;
      cameras.own.back().model.marks.ahead_m = ahead_m;
    }
    const NodeId node = *cluster.find_node("feature");
    const auto steps =
        make_steps({&drive.scenario, &cluster, StrategyKind::kTt, 1, 0, nullptr, nullptr, nullptr}, node);
    Steering seen;
    for (std::size_t t = 0; t < steps.size(); ++t) {
      const schedules::model::Task& task = cluster.node(node).tasks[t];
      if (task.step != "lane_keeping") continue;
      const GlobalTime now = GlobalTime{} + Duration::milliseconds(1'000);
      std::vector<nodes::host::Output> lists, outputs;
      std::vector<nodes::host::Input> inputs;
      for (const auto& port : task.reads) {
        nodes::host::Output& list = lists.emplace_back(port.port, port.pdu, cluster.pdu(port.pdu));
        list.begin(1, 1, now);
        const std::pair<const char*, double> values[] = {{"offset", 1.75},  {"heading", 0.02}, {"curvature", 0.0},
                                                         {"validity", 1.0}, {"speed", 20.0},   {"yaw_rate", 0.0}};
        for (const auto& [name, value] : values)
          if (const auto signal = schedules::model::find_signal(list.layout().element, name))
            list.set(0, *signal, value);
      }
      for (std::size_t i = 0; i < lists.size(); ++i)
        inputs.push_back({task.reads[i].port, task.reads[i].pdu, &lists[i].layout(), lists[i].view(), true});
      for (const auto& port : task.writes) outputs.emplace_back(port.port, port.pdu, cluster.pdu(port.pdu));
      nodes::host::StepContext context;
      context.stamp.global = now;
      context.inputs = inputs;
      context.outputs = outputs;
      context.sink = &seen;
      steps[t]->run(context);
    }
    return seen.angle;
  };
  const double near = steering(10.0, 25.0);
  EXPECT_EQ(near, steering(10.0, 10.0));
  EXPECT_NE(near, steering(25.0, 10.0));
}

}  // namespace
}  // namespace ttf::sim::drives
