// The motion planner sees cars by hand; low-level control follows plans by hand.
#include "nodes/driving/motion_planner.h"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <vector>

#include "nodes/driving/vehicle_control.h"
#include "schedules/file/loader.h"

namespace ttf::nodes::driving {
namespace {

using namespace recording::records;

constexpr GlobalTime planned_ms(std::int64_t ms) { return GlobalTime{} + Duration::milliseconds(ms); }

const schedules::model::Cluster& planned_cluster() {
  static const schedules::model::Cluster kCluster =
      schedules::file::load_cluster(TTF_SOURCE_DIR "/schedules/adaptive_loop_synchronised.yaml");
  return kCluster;
}
const schedules::model::Task& planned_task(const char* node, const char* step) {
  for (const schedules::model::Task& task : planned_cluster().node(*planned_cluster().find_node(node)).tasks)
    if (task.step == step) return task;
  throw std::runtime_error(step);
}

// A task of the shipped cluster with the lists that it reads by hand, and room for those that it writes.
struct Bench : Sink {
  const schedules::model::Task& task;
  std::vector<host::Output> read, written;
  std::vector<host::Input> inputs;
  std::uint32_t activation = 0;
  std::int64_t now_ms = 1'000;

  explicit Bench(const schedules::model::Task& of) : task(of) {
    for (const auto& port : task.reads) {
      read.emplace_back(port.port, port.pdu, planned_cluster().pdu(port.pdu));
      inputs.push_back({port.port, port.pdu, &planned_cluster().pdu(port.pdu), std::nullopt, false});
    }
    for (const auto& port : task.writes) written.emplace_back(port.port, port.pdu, planned_cluster().pdu(port.pdu));
  }
  host::Output& list(std::string_view port, int count, std::int64_t at) {
    for (std::size_t i = 0; i < read.size(); ++i) {
      if (read[i].port() != port) continue;
      read[i].begin(7, count, planned_ms(at));
      inputs[i].list = read[i].view();
      inputs[i].fresh = true;
      return read[i];
    }
    throw std::runtime_error("no such port");
  }
  void odometry(double speed, double yaw_rate = 0.0) {
    host::Output& odometry = list("odometry", 1, now_ms);
    const auto& element = odometry.layout().element;
    odometry.set(0, *schedules::model::find_signal(element, "speed"), speed);
    odometry.set(0, *schedules::model::find_signal(element, "yaw_rate"), yaw_rate);
  }
  void run(host::Step& step) {
    host::StepContext context;
    context.stamp.global = planned_ms(now_ms);
    context.stamp.local = LocalTime{} + Duration::milliseconds(now_ms);
    context.activation = activation++;
    context.inputs = inputs;
    context.outputs = written;
    context.sink = this;
    step.run(context);
    for (host::Input& input : inputs) input.fresh = false;
    for (host::Output& output : written) output.clear();
  }
};

struct Planning final : Bench {
  MotionPlanner step;
  std::optional<PlanMade> plan;

  explicit Planning(std::vector<Picture> pictures = {})
      : Bench(planned_task("planner", "motion_planner")), step(planned_cluster(), task, {}, std::move(pictures)) {}
  using Sink::on;
  void on(const PlanMade& made) override { plan = made; }

  struct Car {
    double gap = 40.0, y = 0.0, speed = 29.0;
    bool confirmed = true;
  };
  // Ten milliseconds later, with these cars ahead: 4 m long.
  void see(const std::vector<Car>& cars, double yaw_rate = 0.0) {
    now_ms += 10;
    odometry(29.0, yaw_rate);
    host::Output& image = list("image", static_cast<int>(cars.size()), now_ms);
    const fusion::ImageSignals signals = fusion::bind_image(planned_cluster(), image.layout());
    for (std::size_t i = 0; i < cars.size(); ++i) {
      ttf::fusion::tracks::TrackView view;
      view.id = static_cast<TrackId>(i);
      view.state(0) = cars[i].gap + 3.4 + 2.0;
      view.state(1) = cars[i].y;
      view.state(2) = view.speed = cars[i].speed;
      view.covariance.setIdentity();
      view.length = 4.0;
      view.width = 1.8;
      view.confirmed = cars[i].confirmed;
      fusion::encode_image_object(view, image, static_cast<int>(i), signals);
    }
    run(step);
  }
  void start_up() {
    for (int i = 0; i < 260; ++i) see({{}});
  }
};

TEST(MotionPlanner, PlansBehindTheMostImportantObject) {
  Planning planning;
  planning.see({{.gap = 30.0}});
  EXPECT_TRUE(planning.plan->valid);
  EXPECT_NEAR(planning.plan->speed, 30.0, 0.01) << "start-up";
  planning.start_up();
  EXPECT_EQ(planning.plan->state, PlannerState::kHold);
  planning.see({{.gap = 36.5, .speed = 29.0}, {.gap = 20.0, .y = 3.5}, {.gap = 10.0, .confirmed = false}});
  EXPECT_EQ(planning.plan->state, PlannerState::kDecelerate)
      << "too near; the nearer ones are beside the lane, or not confirmed";
  EXPECT_NEAR(planning.plan->speed, 28.5, 0.01);
  EXPECT_EQ(planning.plan->track, TrackId{0});
  EXPECT_NEAR(planning.plan->gap, 36.5, 0.02);
  planning.see({{.gap = 36.0, .speed = 27.5}});
  EXPECT_EQ(planning.plan->state, PlannerState::kStop) << "its speed fell through 28 m/s";
  EXPECT_EQ(planning.plan->speed, 0.0);
  planning.see({});
  EXPECT_EQ(planning.plan->state, PlannerState::kStop) << "a stop is for ever";
}

TEST(MotionPlanner, FollowsItsLaneByOdometry) {
  Planning planning;
  planning.start_up();
  // A turn to the left of 0.1 rad: what is straight ahead then is beside the own lane after 40 m.
  for (int i = 0; i < 10; ++i) planning.see({{}}, 0.1 / 0.1);
  EXPECT_NEAR(planning.plan->heading, 0.1, 0.006);
  planning.see({{.gap = 40.0}});
  EXPECT_EQ(planning.plan->track, kNoTrack);
  planning.see({{.gap = 40.0, .y = -4.5}});
  EXPECT_EQ(planning.plan->track, TrackId{0});
}

TEST(MotionPlanner, WithoutAViewOnlyAStopIsValid) {
  Planning planning;
  planning.start_up();
  planning.now_ms += 250;
  planning.run(planning.step);
  EXPECT_FALSE(planning.plan->valid);
  planning.see({{.speed = 28.5}});
  planning.see({{.speed = 27.5}});
  planning.now_ms += 250;
  planning.run(planning.step);
  EXPECT_TRUE(planning.plan->valid);
  EXPECT_EQ(planning.plan->speed, 0.0);
}

TEST(RegionOfInterest, HoldsTheBoxInsideThePicture) {
  const Picture picture{SensorId{2}, 1.0, 0.0, 0.0, 1.4, 1000.0, 360.0, 360.0};
  ImageObject car;
  car.x = 43.0;  // its rear is 40 m before the camera
  car.length = 4.0;
  car.width = 1.8;
  const InterestConfig box{.margin_px = 0.0, .least_area = 0.0};
  auto region = region_of(picture, box, car);
  ASSERT_TRUE(region);
  EXPECT_EQ(region->sensor, SensorId{2});
  EXPECT_NEAR(region->x, -22.5, 1e-9);
  EXPECT_NEAR(region->width, 45.0, 1e-9);
  EXPECT_NEAR(region->y, -1000.0 * 0.1 / 40.0, 1e-9);
  EXPECT_NEAR(region->height, 1000.0 * 1.5 / 40.0, 1e-9);
  region = region_of(picture, {.margin_px = 10.0, .least_area = 0.0}, car);
  EXPECT_NEAR(region->width, 65.0, 1e-9);
  region = region_of(picture, {.least_area = 0.25}, car);
  EXPECT_NEAR(region->area(), 0.25 * 720.0 * 720.0, 1e-6);
  EXPECT_NEAR(region->x + 0.5 * region->width, 0.0, 1e-9);
  car.y = 14.0;  // at the picture's left edge: the region is moved into it
  region = region_of(picture, {.least_area = 0.25}, car);
  ASSERT_TRUE(region);
  EXPECT_NEAR(region->x, -360.0, 1e-9);
  EXPECT_NEAR(region->area(), 0.25 * 720.0 * 720.0, 1e-6);
  car.y = 16.0;
  EXPECT_FALSE(region_of(picture, box, car)) << "beside the picture";
  car.y = 0.0;
  EXPECT_FALSE(region_of({SensorId{3}, 1.0, 0.0, 0.6, 1.4, 1000.0, 360.0, 360.0}, box, car));
}

TEST(MotionPlanner, SendsARegionOfTheCameraThatSeesTheObject) {
  Planning planning({{SensorId{1}, 1.0, 0.0, 0.6}, {SensorId{0}, 1.0, 0.0, 0.0}});
  planning.see({{}});
  EXPECT_EQ(planning.plan->camera, SensorId{0});
  EXPECT_GT(planning.plan->region[2], 40.0);
  planning.see({});
  EXPECT_EQ(planning.plan->camera, kNoSensor);
}

struct Controlling final : Bench {
  VehicleControl step{planned_cluster(), task, {}};
  std::optional<CommandIssued> command;

  Controlling() : Bench(planned_task("control", "vehicle_control")) {}
  using Sink::on;
  void on(const CommandIssued& issued) override { command = issued; }

  void follow(double planned, double speed, double yaw_rate = 0.0, bool valid = true) {
    now_ms += 10;
    odometry(speed, yaw_rate);
    host::Output& plan = list("plan", 1, now_ms);
    const PlanSignals signals = bind_plan(planned_cluster(), plan.layout());
    plan.set(0, signals[0], valid ? 1.0 : 0.0);
    plan.set(0, signals[1], planned);
    run(step);
  }
};

TEST(VehicleControl, TurnsAPlannedSpeedIntoAnAccelerationWithinLimits) {
  Controlling control;
  control.follow(29.4, 29.0);
  EXPECT_TRUE(control.command->valid);
  EXPECT_EQ(control.command->reason, CommandReason::kPlan);
  EXPECT_NEAR(control.command->acceleration, 2.5 * 0.4, 0.002);
  control.follow(29.4, 29.0);
  EXPECT_NEAR(control.command->acceleration, 2.5 * 0.4 + 0.4 * 0.0, 0.006) << "the first step took no time";
  for (int i = 0; i < 99; ++i) control.follow(29.4, 29.0);
  EXPECT_NEAR(control.command->acceleration, 1.0 + 0.4 * 0.99, 0.01);
  control.follow(40.0, 29.0);
  EXPECT_NEAR(control.command->acceleration, 3.0, 1e-9);
  // It brakes from 29 m/s to a standstill: the integral has gone nearly to the limit, so that the brakes do not let go.
  double speed = 29.0;
  for (; speed > 0.0; speed -= 0.06) {
    control.follow(0.0, speed);
    ASSERT_LT(control.command->acceleration, speed > 1.0 ? -6.0 + 1e-9 : -5.0) << speed;
  }
  control.follow(0.0, 0.0);
  EXPECT_LT(control.command->acceleration, -5.0) << "and holds it";
}

// The node had no global time for two seconds, in which its tasks did not execute.
TEST(VehicleControl, BeginsAnewAfterExecutionsThatDidNotHappen) {
  Controlling control;
  for (int i = 0; i < 101; ++i) control.follow(29.4, 29.0);
  EXPECT_GT(control.command->acceleration, 1.3);
  control.now_ms += 2'000;
  control.follow(29.4, 29.0);
  ASSERT_TRUE(control.command->valid);
  EXPECT_NEAR(control.command->acceleration, 2.5 * 0.4, 0.01) << "without an integral, of before or of the gap";
  control.follow(29.4, 29.0);
  EXPECT_NEAR(control.command->acceleration, 2.5 * 0.4, 0.01);
}

TEST(VehicleControl, SteersBackToTheLineThatItStartedOn) {
  Controlling control;
  control.follow(20.0, 20.0);
  EXPECT_EQ(control.command->steering, 0.0);
  for (int i = 0; i < 10; ++i) control.follow(20.0, 20.0, 0.2);
  EXPECT_LT(control.command->steering, -0.01) << "it points to the left of its line";
  for (int i = 0; i < 10; ++i) control.follow(20.0, 20.0, -0.2);
  for (int i = 0; i < 2; ++i) control.follow(20.0, 20.0);
  // It points along the line again, some 4 cm to the left of it.
  EXPECT_LT(control.command->steering, 0.0);
  EXPECT_GT(control.command->steering, -0.1);
}

TEST(VehicleControl, FollowsNoOldOrInvalidPlan) {
  Controlling control;
  control.follow(29.0, 29.0, 0.0, false);
  EXPECT_FALSE(control.command->valid);
  control.follow(29.0, 29.0);
  EXPECT_TRUE(control.command->valid);
  for (const auto& [later, valid] : {std::pair{90, true}, std::pair{20, false}}) {
    control.now_ms += later;
    control.odometry(29.0);
    control.run(control.step);
    EXPECT_EQ(control.command->valid, valid) << later;
  }
}

}  // namespace
}  // namespace ttf::nodes::driving
