// The actuator accepts and refuses commands by hand; emergency braking sees a car by hand.
#include "nodes/driving/actuator.h"

#include <gtest/gtest.h>

#include <optional>
#include <vector>

#include "nodes/driving/emergency_braking.h"
#include "schedules/file/loader.h"

namespace ttf::nodes::driving {
namespace {

using namespace recording::records;

constexpr GlobalTime at_ms(std::int64_t ms) { return GlobalTime{} + Duration::milliseconds(ms); }

const schedules::model::Cluster& cluster() {
  static const schedules::model::Cluster kCluster =
      schedules::file::load_cluster(TTF_SOURCE_DIR "/schedules/closed_loop_synchronised.yaml");
  return kCluster;
}
const schedules::model::Task& task_of(const char* node, const char* step) {
  for (const schedules::model::Task& task : cluster().node(*cluster().find_node(node)).tasks)
    if (task.step == step) return task;
  throw std::runtime_error(step);
}

// The shipped cluster's actuator, with commands by hand.
struct ByHand final : Sink {
  Actuator step{cluster(), task_of("actuator", "actuator"), {}};
  std::vector<host::Output> lists;
  std::vector<host::Input> inputs;
  bool global_time = true;
  std::optional<CommandTaken> taken;
  std::optional<host::Actuation> actuation;

  ByHand() {
    for (const char* const name : {"cruise_command", "emergency_command"}) {
      const PduId pdu = *cluster().find_pdu(name);
      lists.emplace_back("command", pdu, cluster().pdu(pdu));
      inputs.push_back({lists.size() == 1 ? "command" : "emergency", pdu, &cluster().pdu(pdu), std::nullopt, false});
    }
  }
  using Sink::on;
  void on(const CommandTaken& r) override { taken = r; }

  void receive(std::size_t port, const Command& command, GlobalTime issued) {
    const auto signals = bind_command(cluster(), lists[port].layout());
    lists[port].begin(7, 1, issued);
    lists[port].set(0, signals[0], command.valid ? 1.0 : 0.0);
    lists[port].set(0, signals[1], command.acceleration);
    lists[port].set(0, signals[2], command.steering);
    inputs[port].list = lists[port].view();
    inputs[port].fresh = true;
  }
  void run(GlobalTime now) {
    host::StepContext context;
    context.stamp.global = now;
    context.stamp.true_time = TrueTime{now.ns + 5};
    context.global_time = global_time;
    context.inputs = inputs;
    context.sink = this;
    step.run(context);
    actuation = context.actuation;
    for (host::Input& input : inputs) input.fresh = false;
  }
};

TEST(Actuator, HandsACommandOverAfterItsDeadTime) {
  ByHand loop;
  loop.receive(0, {true, -1.5, 0.01}, at_ms(40));
  loop.run(at_ms(45));
  ASSERT_TRUE(loop.actuation);
  EXPECT_EQ(loop.actuation->from, TrueTime{} + Duration::milliseconds(95) + Duration{5});
  EXPECT_NEAR(loop.actuation->acceleration, -1.5, 1e-9);
  EXPECT_NEAR(loop.actuation->steering, 0.01, 1e-9);
  EXPECT_EQ(loop.taken->verdict, kApplied);
  loop.run(at_ms(85));
  EXPECT_FALSE(loop.actuation);
  EXPECT_EQ(loop.taken->verdict, kNoNewCommand);
}

TEST(Actuator, RefusesOldFutureAndInvalidCommands) {
  ByHand loop;
  const Duration oldest = sim::world::vehicle::ActuatorConfig{}.oldest;
  loop.receive(0, {true, -1.0, 0.0}, at_ms(40));
  loop.run(at_ms(40) + oldest);
  EXPECT_EQ(loop.taken->verdict, kApplied);
  loop.receive(0, {true, -1.0, 0.0}, at_ms(40));
  loop.run(at_ms(40) + oldest + Duration{1});
  EXPECT_EQ(loop.taken->verdict, kLateCommand);
  EXPECT_FALSE(loop.actuation);
  EXPECT_TRUE(loop.inputs[0].discarded);
  // A round has 320 ms, so that 250 ms before the reading is the same place in it as 70 ms after.
  loop.receive(0, {true, -1.0, 0.0}, at_ms(40));
  loop.run(at_ms(290));
  EXPECT_EQ(loop.taken->verdict, kLateCommand);
  loop.receive(0, {true, -1.0, 0.0}, at_ms(155));
  loop.run(at_ms(40));
  EXPECT_EQ(loop.taken->verdict, kLateCommand);
  loop.receive(0, {false, -1.0, 0.0}, at_ms(40));
  loop.run(at_ms(45));
  EXPECT_EQ(loop.taken->verdict, kInvalidCommand);
  EXPECT_FALSE(loop.actuation);
  loop.global_time = false;
  loop.receive(0, {true, -1.0, 0.0}, at_ms(40));
  loop.run(at_ms(45));
  EXPECT_EQ(loop.taken->verdict, kLateCommand) << "without global time no age is known";
}

TEST(Actuator, TheStrongerDecelerationCounts) {
  ByHand loop;
  loop.receive(0, {true, -1.0, 0.02}, at_ms(40));
  loop.receive(1, {true, -8.0, 0.0}, at_ms(40));
  loop.run(at_ms(45));
  EXPECT_NEAR(loop.actuation->acceleration, -8.0, 1e-9);
  EXPECT_NEAR(loop.actuation->steering, 0.02, 1e-9) << "the wheels stay with the other service";
  loop.receive(0, {true, -1.0, 0.02}, at_ms(80));
  loop.receive(1, {false, -8.0, 0.0}, at_ms(80));
  loop.run(at_ms(85));
  EXPECT_NEAR(loop.actuation->acceleration, -1.0, 1e-9);
  loop.receive(1, {true, -8.0, 0.0}, at_ms(120));
  loop.run(at_ms(125));
  EXPECT_NEAR(loop.actuation->acceleration, -8.0, 1e-9) << "also without the other one";
}

// Emergency braking with images and odometry by hand.
struct Braking final : Sink {
  EmergencyBraking step{cluster(), task_of("feature", "emergency_braking"), {}};
  std::vector<Warning> warnings;
  std::optional<CommandIssued> issued;

  using Sink::on;
  void on(const Warning& r) override { warnings.push_back(r); }
  void on(const CommandIssued& r) override { issued = r; }

  // One car ahead: its middle, and its speed. The own speed was measured that long ago.
  void look(double x, double speed, double own_speed, Duration measured = {}) {
    constexpr GlobalTime kNow = at_ms(1'000);
    const schedules::model::Task& task = task_of("feature", "emergency_braking");
    const PduId image_pdu = *cluster().find_pdu("image"), odometry_pdu = *cluster().find_pdu("odometry_list"),
                command_pdu = *cluster().find_pdu("emergency_command");
    host::Output image("image", image_pdu, cluster().pdu(image_pdu));
    ttf::fusion::tracks::TrackView car;
    car.state(0) = x;
    car.state(2) = speed;
    car.speed = speed;
    car.covariance.setIdentity();
    car.length = 4.0;
    car.width = 1.8;
    car.confirmed = true;
    image.begin(1, 1, kNow);
    fusion::encode_image_object(car, image, 0, fusion::bind_image(cluster(), cluster().pdu(image_pdu)));
    host::Output odometry("odometry", odometry_pdu, cluster().pdu(odometry_pdu));
    odometry.begin(1, 1, kNow - measured);
    odometry.set(0, *schedules::model::find_signal(cluster().pdu(odometry_pdu).element, "speed"), own_speed);
    std::vector<host::Input> inputs;
    for (const auto& port : task.reads) {
      const host::Output& list = port.pdu == image_pdu ? image : odometry;
      inputs.push_back({port.port, port.pdu, &cluster().pdu(port.pdu), list.view(), true});
    }
    std::vector<host::Output> outputs;
    outputs.emplace_back("command", command_pdu, cluster().pdu(command_pdu));
    host::StepContext context;
    context.stamp.global = kNow;
    context.inputs = inputs;
    context.outputs = outputs;
    context.sink = this;
    step.run(context);
  }
};

TEST(EmergencyBraking, WarnsThenBrakesAndEndsWhenNothingIsApproached) {
  Braking braking;
  braking.look(60.0, 10.0, 20.0);
  EXPECT_TRUE(braking.warnings.empty());
  EXPECT_FALSE(braking.issued->valid);
  const double clearance = braking.issued->gap;
  EXPECT_GT(clearance, 50.0);
  EXPECT_LT(clearance, 60.0 - 3.4);
  braking.look(60.0 - clearance + 26.0, 10.0, 20.0);  // 2.6 s
  ASSERT_EQ(braking.warnings.size(), 1u);
  EXPECT_EQ(braking.warnings[0].service, kForwardCollision);
  EXPECT_NEAR(braking.warnings[0].time_to_collision_s, 2.6, 0.01);
  EXPECT_FALSE(braking.issued->valid);
  braking.look(60.0 - clearance + 15.0, 10.0, 20.0);  // 1.5 s
  ASSERT_EQ(braking.warnings.size(), 2u);
  EXPECT_EQ(braking.warnings[1].service, kEmergencyBraking);
  EXPECT_TRUE(braking.issued->valid);
  EXPECT_NEAR(braking.issued->acceleration, -8.0, 1e-9);
  braking.look(60.0 - clearance + 12.0, 10.0, 12.0);  // 6 s: it goes on
  EXPECT_TRUE(braking.issued->valid);
  braking.look(60.0 - clearance + 11.0, 10.0, 10.0);
  EXPECT_FALSE(braking.issued->valid);
  ASSERT_EQ(braking.warnings.size(), 4u);
  EXPECT_FALSE(braking.warnings[2].on);
  EXPECT_FALSE(braking.warnings[3].on);
}

TEST(EmergencyBraking, DoesNotTrustTheSpeedOfOdometryThatHasStopped) {
  Braking braking;
  braking.look(20.0, 0.0, 20.0, Duration::milliseconds(150));
  EXPECT_TRUE(braking.issued->valid);
  braking.look(20.0, 0.0, 20.0, Duration::milliseconds(250));
  EXPECT_FALSE(braking.issued->valid);
  EXPECT_EQ(braking.warnings.size(), 2u) << "the warnings stay";
}

}  // namespace
}  // namespace ttf::nodes::driving
