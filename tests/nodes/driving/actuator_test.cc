// The actuator accepts and refuses commands by hand; emergency braking and adaptive cruise control see a car by hand.
#include "nodes/driving/actuator.h"

#include <gtest/gtest.h>

#include <optional>
#include <vector>

#include "nodes/driving/adaptive_cruise_control.h"
#include "nodes/driving/emergency_braking.h"
#include "nodes/host/signals.h"
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
  std::vector<CommandVerdict> verdicts;  // in the last reading
  std::optional<host::Actuation> actuation;

  ByHand() {
    for (const char* const name : {"cruise_command", "emergency_command"}) {
      const PduId pdu = *cluster().find_pdu(name);
      lists.emplace_back("command", pdu, cluster().pdu(pdu));
      inputs.push_back({lists.size() == 1 ? "command" : "emergency", pdu, &cluster().pdu(pdu), std::nullopt, false});
    }
  }
  using Sink::on;
  void on(const CommandTaken& r) override {
    taken = r;
    verdicts.push_back(r.verdict);
  }

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
    verdicts.clear();
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
  EXPECT_EQ(loop.taken->verdict, CommandVerdict::kApplied);
  loop.run(at_ms(85));
  EXPECT_FALSE(loop.actuation);
  EXPECT_EQ(loop.taken->verdict, CommandVerdict::kNoneNew);
}

TEST(Actuator, RefusesOldFutureAndInvalidCommands) {
  ByHand loop;
  const Duration oldest = sim::world::vehicle::ActuatorConfig{}.oldest;
  loop.receive(0, {true, -1.0, 0.0}, at_ms(40));
  loop.run(at_ms(40) + oldest);
  EXPECT_EQ(loop.taken->verdict, CommandVerdict::kApplied);
  loop.receive(0, {true, -1.0, 0.0}, at_ms(40));
  loop.run(at_ms(40) + oldest + Duration{1});
  EXPECT_EQ(loop.taken->verdict, CommandVerdict::kLate);
  EXPECT_FALSE(loop.actuation);
  EXPECT_TRUE(loop.inputs[0].discarded);
  // A round has 320 ms, so that 250 ms before the reading is the same place in it as 70 ms after.
  loop.receive(0, {true, -1.0, 0.0}, at_ms(40));
  loop.run(at_ms(290));
  EXPECT_EQ(loop.taken->verdict, CommandVerdict::kLate);
  loop.receive(0, {true, -1.0, 0.0}, at_ms(155));
  loop.run(at_ms(40));
  EXPECT_EQ(loop.taken->verdict, CommandVerdict::kLate);
  loop.receive(0, {false, -1.0, 0.0}, at_ms(40));
  loop.run(at_ms(45));
  EXPECT_EQ(loop.taken->verdict, CommandVerdict::kInvalid);
  EXPECT_FALSE(loop.actuation);
  loop.global_time = false;
  loop.receive(0, {true, -1.0, 0.0}, at_ms(40));
  loop.run(at_ms(45));
  EXPECT_EQ(loop.taken->verdict, CommandVerdict::kLate) << "without global time no age is known";
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

// A list of either service is lost: its last command counts on until it is too old, and no longer than its service
// says.
TEST(Actuator, AnAcceptedCommandOutlivesTheLossOfTheNextList) {
  ByHand loop;
  loop.receive(0, {true, -1.0, 0.02}, at_ms(40));
  loop.receive(1, {true, -8.0, 0.0}, at_ms(40));
  loop.run(at_ms(45));
  loop.receive(0, {true, -3.5, 0.01}, at_ms(80));
  loop.run(at_ms(85));
  EXPECT_NEAR(loop.actuation->acceleration, -8.0, 1e-9);
  EXPECT_NEAR(loop.actuation->steering, 0.01, 1e-9);
  EXPECT_EQ(loop.verdicts, (std::vector<CommandVerdict>{CommandVerdict::kWeaker, CommandVerdict::kApplied}));
  loop.receive(0, {true, -3.5, 0.0}, at_ms(140));
  loop.run(at_ms(145));
  EXPECT_NEAR(loop.actuation->acceleration, -3.5, 1e-9) << "105 ms are too old";
  loop.receive(1, {true, -8.0, 0.0}, at_ms(160));
  loop.run(at_ms(165));
  loop.receive(1, {false, 0.0, 0.0}, at_ms(180));
  loop.run(at_ms(185));
  EXPECT_NEAR(loop.actuation->acceleration, -3.5, 1e-9) << "emergency braking ends while the other list is lost";
  EXPECT_EQ(loop.verdicts, (std::vector<CommandVerdict>{CommandVerdict::kNoneNew, CommandVerdict::kNothingAsked,
                                                        CommandVerdict::kApplied}));
}

TEST(Actuator, TheFateOfEachListOfEmergencyBrakingIsOnRecord) {
  ByHand loop;
  loop.receive(0, {true, -1.0, 0.0}, at_ms(200));
  loop.receive(1, {true, -8.0, 0.0}, at_ms(40));
  loop.run(at_ms(205));
  EXPECT_NEAR(loop.actuation->acceleration, -1.0, 1e-9);
  EXPECT_EQ(loop.verdicts, (std::vector<CommandVerdict>{CommandVerdict::kApplied, CommandVerdict::kLate}));
  loop.receive(0, {true, -1.0, 0.0}, at_ms(240));
  loop.receive(1, {false, 0.0, 0.0}, at_ms(240));
  loop.run(at_ms(245));
  EXPECT_EQ(loop.verdicts, (std::vector<CommandVerdict>{CommandVerdict::kApplied, CommandVerdict::kNothingAsked}));
}

// A service with images and odometry by hand.
template <class Service> struct ByEye : Sink {
  const char* name;
  Service step;
  std::vector<Warning> warnings;
  std::optional<CommandIssued> issued;
  std::int64_t executions = 0;
  Duration skipped{};

  explicit ByEye(const char* service) : name(service), step(cluster(), task_of("feature", service), {}) {}
  using Sink::on;
  void on(const Warning& r) override { warnings.push_back(r); }
  void on(const CommandIssued& r) override { issued = r; }

  // One car ahead: its middle, and its speed. The own speed was measured that long ago.
  // Executions are 40 ms apart.
  void look(double x, double speed, double own_speed, Duration measured = {}) {
    constexpr GlobalTime kNow = at_ms(1'000);
    const schedules::model::Task& task = task_of("feature", name);
    const PduId image_pdu = *cluster().find_pdu("image"), odometry_pdu = *cluster().find_pdu("odometry_list"),
                command_pdu = host::binding_of(task.writes, "command").pdu;
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
    context.stamp.local = LocalTime{} + executions * Duration::milliseconds(40) + skipped;
    context.activation = static_cast<std::uint32_t>(executions++);
    context.inputs = inputs;
    context.outputs = outputs;
    context.sink = this;
    step.run(context);
  }
};

struct Braking : ByEye<EmergencyBraking> {
  Braking() : ByEye("emergency_braking") {}
};
struct Cruising : ByEye<AdaptiveCruiseControl> {
  Cruising() : ByEye("adaptive_cruise_control") {}
  void look_away() { look(60.0, 10.0, 20.0, Duration::milliseconds(250)); }
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
  EXPECT_EQ(braking.warnings[0].service, WarningKind::kForwardCollision);
  EXPECT_NEAR(braking.warnings[0].time_to_collision_s, 2.6, 0.01);
  EXPECT_FALSE(braking.issued->valid);
  braking.look(60.0 - clearance + 15.0, 10.0, 20.0);  // 1.5 s
  ASSERT_EQ(braking.warnings.size(), 2u);
  EXPECT_EQ(braking.warnings[1].service, WarningKind::kEmergencyBraking);
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

// The law's command, 2.5 m/s^3 away at most: 0.1 m/s^2 an execution.
TEST(AdaptiveCruiseControl, FollowsTheLawWithinItsLimits) {
  Cruising cruising;
  cruising.look(200.0, 20.0, 20.0);
  EXPECT_TRUE(cruising.issued->valid);
  EXPECT_EQ(cruising.issued->reason, CommandReason::kSetSpeed);
  EXPECT_NEAR(cruising.issued->acceleration, 0.0, 1e-9) << "nothing goes before the first execution";
  cruising.look(200.0, 20.0, 20.0);
  EXPECT_NEAR(cruising.issued->acceleration, 0.1, 2e-3);
  for (int i = 0; i < 60; ++i) cruising.look(200.0, 20.0, 20.0);
  EXPECT_NEAR(cruising.issued->acceleration, 2.0, 2e-3) << "0.4 * (30 - 20) is beyond the limit";
  for (int i = 0; i < 60; ++i) cruising.look(45.0, 18.0, 20.0);
  EXPECT_EQ(cruising.issued->reason, CommandReason::kGap);
  const double law = 0.23 * (cruising.issued->gap - 2.0 - 1.5 * 20.0) + 0.74 * (18.0 - 20.0);
  ASSERT_GT(law, -3.5);
  EXPECT_NEAR(cruising.issued->acceleration, law, 0.02);
  for (int i = 0; i < 60; ++i) cruising.look(15.0, 0.0, 20.0);
  EXPECT_NEAR(cruising.issued->acceleration, -3.5, 2e-3);
}

TEST(AdaptiveCruiseControl, RemembersItsCommandInAGapAsShortAsTheCommandsLife) {
  Cruising cruising;
  for (int i = 0; i < 60; ++i) cruising.look(15.0, 0.0, 20.0);
  cruising.look_away();
  EXPECT_FALSE(cruising.issued->valid);
  cruising.look(15.0, 0.0, 20.0);
  EXPECT_NEAR(cruising.issued->acceleration, -3.5, 2e-3);
  for (int i = 0; i < 3; ++i) cruising.look_away();
  cruising.look(15.0, 0.0, 20.0);
  EXPECT_NEAR(cruising.issued->acceleration, -3.5, 2e-3) << "the brakes are not given up after 160 ms either";
}

TEST(AdaptiveCruiseControl, BeginsAnewWithoutAnAccelerationAfterALongerGap) {
  Cruising cruising;
  for (int i = 0; i < 60; ++i) cruising.look(200.0, 20.0, 20.0);
  EXPECT_NEAR(cruising.issued->acceleration, 2.0, 2e-3);
  for (int i = 0; i < 3; ++i) cruising.look_away();
  cruising.look(200.0, 20.0, 20.0);
  EXPECT_NEAR(cruising.issued->acceleration, 0.1, 2e-3);
}

// The node had no global time for two seconds, in which its tasks did not execute.
TEST(AdaptiveCruiseControl, BeginsAnewAfterExecutionsThatDidNotHappen) {
  Cruising accelerates, brakes;
  for (int i = 0; i < 60; ++i) accelerates.look(200.0, 20.0, 20.0);
  for (int i = 0; i < 60; ++i) brakes.look(15.0, 0.0, 20.0);
  for (Cruising* const one : {&accelerates, &brakes}) {
    one->skipped += Duration::milliseconds(2'000);
    one->look(200.0, 20.0, 20.0);
  }
  EXPECT_NEAR(accelerates.issued->acceleration, 0.25, 2e-3) << "the jerk of 100 ms, the memory";
  EXPECT_NEAR(brakes.issued->acceleration, -3.25, 2e-3) << "the brakes are released by that jerk";
  accelerates.look(200.0, 20.0, 20.0);
  EXPECT_NEAR(accelerates.issued->acceleration, 0.35, 2e-3);
}

// A vehicle that stands holds its brakes until the law asks for 0.3 m/s^2.
TEST(AdaptiveCruiseControl, WaitsAtAStandstill) {
  Cruising cruising;
  for (int i = 0; i < 60; ++i) cruising.look(8.0, 0.0, 0.0);
  EXPECT_NEAR(cruising.issued->acceleration, -1.0, 2e-3);
  for (int i = 0; i < 60; ++i) cruising.look(14.0, 0.0, 0.0);
  EXPECT_GT(cruising.issued->acceleration, 0.3);
}

}  // namespace
}  // namespace ttf::nodes::driving
