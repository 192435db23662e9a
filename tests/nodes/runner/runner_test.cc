// One node in real time, by a clock that the test turns: its actions and counts, to the nanosecond. The
// others of its cluster are silent, or played by a script.
#include "nodes/runner/runner.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "bus/wire/strobe.h"
#include "schedules/analysis/can_load.h"
#include "tests/nodes/runner/lone_node.h"

namespace ttf::nodes::runner {
namespace {

TEST_F(RunnerTest, AWakeUpInTimeIsNeverLate) {
  Alone gateway(*this, "gateway", {.lasts = ms(20)});
  EXPECT_EQ(gateway.run(), RunnerEnd::kDone);
  EXPECT_EQ(gateway.host.now(), gateway.at(ms(20)));
  EXPECT_EQ(gateway.sent(), gateway_slots(4));
  EXPECT_TRUE(gateway.out.ordered);
  EXPECT_TRUE(gateway.out.problems.empty());
  EXPECT_EQ(gateway.health.wakeup_longest, Duration{});
  EXPECT_EQ(gateway.out.lateness[recording::records::LatenessOf::kDepartures],
            (Recorded::Histogram{4 * 34, Duration{}}));
  EXPECT_EQ(gateway.health.medium.sent, 4u * 34);
}

// The window's last instant is in time, for a frame and for all other acts.
TEST_F(RunnerTest, AWakeUpAsLateAsTheWindowAllowsIsInTime) {
  const Duration late = cluster_.arrival_window->late;
  Alone gateway(*this, "gateway", {.lasts = ms(20)});
  gateway.wakes = late_by(late);
  gateway.run();
  EXPECT_EQ(gateway.sent(), gateway_slots(4));
  EXPECT_TRUE(gateway.out.problems.empty());
  EXPECT_EQ(gateway.health.wakeup_longest, late);
  EXPECT_EQ(gateway.out.lateness[recording::records::LatenessOf::kDepartures].longest, late);
}

TEST_F(RunnerTest, AFrameThatIsANanosecondTooLateIsNotSentAndReported) {
  const Duration too_late = cluster_.arrival_window->late + Duration{1};
  Alone gateway(*this, "gateway", {.lasts = ms(20)});
  gateway.wakes = late_by(too_late);
  gateway.run();
  EXPECT_EQ(gateway.sent_or_missed(), gateway_slots(4));
  EXPECT_THAT(gateway.missed(), testing::IsSupersetOf({SlotOfCycle{0, 3, 0}, {0, 3, 1}})) << "what it is woken up for";
  EXPECT_LE(gateway.out.lateness[recording::records::LatenessOf::kDepartures].longest, cluster_.arrival_window->late);
  EXPECT_EQ(gateway.health.timing.slots_missed, gateway.missed().size());
  EXPECT_EQ(gateway.health.medium.sent, gateway.sent().size());
  EXPECT_GT(gateway.health.timing.late_wakeups, 0u);
  EXPECT_EQ(gateway.health.timing.late_wakeups, gateway.out.reported(recording::records::TimingFault::kLateWakeUp));
  for (const Recorded::Reported& problem : gateway.out.problems) EXPECT_EQ(problem.late, too_late);
}

// Stopped in cycle 1, going on in cycle 3: it catches up in order, except for frames that are too late.
TEST_F(RunnerTest, AStoppedProcessCatchesUp) {
  Alone gateway(*this, "gateway", {.lasts = ms(20)});
  const bus::ports::MachineTime from = gateway.at(ms(7)), until = gateway.at(ms(16));
  gateway.wakes = stopped(from, until);
  gateway.run();
  std::set<SlotOfCycle> too_late;
  for (const auto& [cycle, slot, channel] : gateway_slots(4)) {
    const bus::ports::MachineTime due = gateway.action_point(cycle, slot);
    // It waits a millisecond for the medium before it goes on.
    if (due >= from && due + cluster_.arrival_window->late < until + ms(1)) too_late.emplace(cycle, slot, channel);
  }
  EXPECT_FALSE(too_late.empty());
  EXPECT_EQ(gateway.missed(), too_late);
  EXPECT_EQ(gateway.sent_or_missed(), gateway_slots(4));
  EXPECT_TRUE(gateway.out.ordered);
}

// The medium's threads were stopped, too: a node more than a cycle behind gives them time to take frames in.
TEST_F(RunnerTest, AProcessMoreThanACycleBehindWaitsForTheMedium) {
  for (const Duration more : {Duration{0}, Duration{1}}) {
    Alone gateway(*this, "gateway", {.lasts = ms(20)});
    std::optional<bus::ports::MachineTime> stops;
    gateway.wakes = [&](bus::ports::MachineTime due) {
      if (due < gateway.action_point(1, 3) - us(1)) return due;
      if (!stops) stops = due;
      return std::max(due, *stops + ms(5) + more);
    };
    gateway.run();
    const Duration pause = more > Duration{} ? ms(1) : Duration{};
    EXPECT_EQ(gateway.health.wakeup_longest, ms(5) + more + pause);
    EXPECT_EQ(gateway.sleeps.size(), pause > Duration{} ? 1u : 0u);
  }
}

// Its fusion, due every 10 ms, takes 12.
TEST_F(RunnerTest, AProcessThatStaysBehindDoesNotWaitForTheMediumAgain) {
  Alone fusion(*this, "fusion", {.lasts = ms(100)});
  fusion.computes = ms(12);
  fusion.run();
  EXPECT_GE(std::count(fusion.sleeps.begin(), fusion.sleeps.end(), ms(12)), 4);
  EXPECT_EQ(std::count(fusion.sleeps.begin(), fusion.sleeps.end(), ms(1)), 1);
}

TEST_F(RunnerTest, IsStoppedByItsDescriptor) {
  Alone gateway(*this, "gateway", {.lasts = ms(20)});
  gateway.stop_descriptor = eventfd(0, EFD_CLOEXEC);
  gateway.host.at(gateway.at(ms(9)), [&] { eventfd_write(gateway.stop_descriptor, 1); });
  EXPECT_EQ(gateway.run(), RunnerEnd::kStopped);
  EXPECT_EQ(gateway.host.now(), gateway.at(ms(9)));
  EXPECT_EQ(gateway.sent(), gateway_slots(2));
  EXPECT_EQ(gateway.out.accounts, 1) << "the account is closed all the same";
  close(gateway.stop_descriptor);
}

// A thousand seconds behind: all of it would take minutes.
TEST_F(RunnerTest, IsStoppedWhileItCatchesUp) {
  Alone gateway(*this, "gateway", {.lasts = ms(1'000'000)});
  gateway.stop_descriptor = eventfd(1, EFD_CLOEXEC);
  gateway.host.turn_to(gateway.at(ms(1'000'000)));
  EXPECT_EQ(gateway.run(), RunnerEnd::kStopped);
  EXPECT_LE(gateway.wake_ups, 1024u);
  close(gateway.stop_descriptor);
}

class BrokenMedium final : public bus::ports::LiveMedium {
 public:
  bus::ports::LiveStatus send(const bus::ports::LiveSignal&, bus::ports::MachineTime) override {
    return bus::ports::LiveStatus::kFailed;
  }
  bus::ports::LiveStatus send_can(std::size_t, const bus::ports::CanFrame&) override {
    return bus::ports::LiveStatus::kFailed;
  }
  std::optional<bus::ports::LiveArrival> receive() override { return std::nullopt; }
  int descriptor(bus::ports::Line) const override { return -1; }
  void watch(bus::ports::Line, bool) override {}
  bus::ports::LiveCounts counts() const override { return {}; }
  const std::string& failure() const override { return why; }
  std::string why;
};

TEST_F(RunnerTest, EndsWhenItsMediumIsOfNoUseAnyMore) {
  Alone gateway(*this, "gateway", {.lasts = ms(20)});
  BrokenMedium medium;
  gateway.host.at(gateway.at(ms(9)), [&] { medium.why = "the line is down"; });
  EXPECT_EQ(gateway.run(&medium), RunnerEnd::kFailed);
  EXPECT_GE(gateway.host.now(), gateway.at(ms(9)));
  EXPECT_LE(gateway.host.now(), gateway.action_point(2, 3)) << "when something was due next";
}

// A frame is late or early by real time, at any scale of the drive's.
TEST_F(RunnerTest, AFrameIsJudgedByItsWindowInRealTime) {
  const auto [early, late] = *cluster_.arrival_window;
  const Duration margin = us(1);  // clocks agree within microticks
  for (const std::int64_t scale : {1'000'000, 4'000'000}) {
    for (const Duration behind : {-early - margin, -early + margin, late - margin, late + margin}) {
      SCOPED_TRACE(testing::Message() << "scale " << scale << ", behind by " << behind.ns);
      Alone gateway(*this, "gateway", {.lasts = ms(10), .scale_ppm = scale});
      gateway.host.at(gateway.action_point(1, 25) + behind, [&] { gateway.others_send(25, 1); });
      gateway.run();
      EXPECT_EQ(gateway.health.timing.late_frames, behind > late ? 1u : 0u);
      EXPECT_EQ(gateway.health.timing.early_frames, behind < -early ? 1u : 0u);
      EXPECT_EQ(gateway.out.lateness[recording::records::LatenessOf::kArrivals].count, 1u);
      EXPECT_LT(std::abs((gateway.out.lateness[recording::records::LatenessOf::kArrivals].longest - behind).ns),
                margin.ns);
    }
  }
}

// The scan's 93 frames are not ready at once: they leave at a CAN FD's pace with the cluster's bit rates, at
// any time scale. A late frame does not delay the next.
TEST_F(RunnerTest, FramesLeaveAsACanWouldCarryThem) {
  for (const std::int64_t scale : {1'000'000, 4'000'000}) {
    SCOPED_TRACE(scale);
    Alone laser(*this, "laser", {.lasts = ms(60), .scale_ppm = scale});
    const auto sensor = *cluster_.find_sensor("laser");
    const std::size_t can = *schedules::model::can_of_lines(cluster_, sensor);
    const DriveClock clock(kOrigin, scale);
    laser.host.at(laser.at(ms(2)), [&] { laser.others_send_can(can, schedules::model::trigger_identifier(sensor)); });
    laser.run();
    ASSERT_THAT(laser.out.measured, testing::ElementsAre(sim::engine::kFirstCycle + ms(2))) << "at once";
    const auto received = laser.received_on_can();
    ASSERT_FALSE(received.empty());
    EXPECT_EQ(received.front().identifier, schedules::model::strobe_identifier(sensor));
    EXPECT_EQ(received.front().at, laser.at(ms(2)));
    EXPECT_EQ(laser.out.can_frames, static_cast<int>(received.size()) - 1);
    EXPECT_GE(received.size(), 1u + 5);
    // Until the list is there; its first frame has no other before it, whose last bits would delay it.
    Duration passed = ms(2) + us(500) - schedules::analysis::can_after_acceptance(cluster_.can_buses[can]);
    for (std::size_t i = 1; i < received.size(); ++i) {
      passed += received[i].duration;
      const Duration behind = received[i].at - laser.at(passed);
      EXPECT_GE(behind, Duration{}) << i;
      EXPECT_LE(behind, clock.in_real(us(2))) << i << ": microticks, and what its own clock is off by";
    }
  }
}

// The interface of a private CAN reports errors and states. Each change of state is reported once.
TEST_F(RunnerTest, ReportsOfItsInterfaceAreRecords) {
  using namespace recording::records;
  Alone laser(*this, "laser", {.lasts = ms(20)});
  const std::size_t can = *schedules::model::can_of_lines(cluster_, *cluster_.find_sensor("laser"));
  bus::ports::CanReport report;
  report.error = CanError::kBit;
  report.as_transmitter = true;
  report.transmit_errors = 8;
  laser.host.at(laser.at(ms(5)), [&, report] { laser.report_on_can(can, report); });
  report = {};
  report.state = CanState::kPassive;
  for (const int at : {7, 8}) laser.host.at(laser.at(ms(at)), [&, report] { laser.report_on_can(can, report); });
  laser.run();
  ASSERT_EQ(laser.out.can_errors.size(), 1u);
  EXPECT_EQ(laser.out.can_errors[0].bus, can);
  EXPECT_EQ(laser.out.can_errors[0].error, CanError::kBit);
  EXPECT_EQ(laser.out.can_errors[0].transmit_errors, 8);
  EXPECT_EQ(laser.out.can_errors[0].stamp.node, id_of("laser"));
  ASSERT_EQ(laser.out.can_states.size(), 1u);
  EXPECT_EQ(laser.out.can_states[0].from, CanState::kActive);
  EXPECT_EQ(laser.out.can_states[0].to, CanState::kPassive);
  EXPECT_EQ(laser.health.can_errors, 1u);
  EXPECT_EQ(laser.health.can_state, CanState::kPassive);
}

TEST_F(RunnerTest, ALineIsKnownByItsForm) {
  Alone camera_pre(*this, "camera_pre", {.lasts = ms(10)});
  const auto sensor = *cluster_.find_sensor("camera");
  const std::size_t can = *schedules::model::can_of_lines(cluster_, sensor);
  const auto strobe = bus::wire::strobe_data(7);
  camera_pre.host.at(camera_pre.at(ms(1)), [&] {
    camera_pre.others_send_can(can, schedules::model::strobe_identifier(sensor), strobe);
    camera_pre.others_send_can(can, schedules::model::strobe_identifier(sensor), std::span(strobe).first(3));
    camera_pre.others_send_can(can, schedules::model::trigger_identifier(sensor), strobe);
    camera_pre.others_send_can(can, schedules::model::trigger_identifier(sensor));  // the device's, not its host's
  });
  camera_pre.run();
  EXPECT_EQ(camera_pre.counts.refused_can_frames, 2u);
  EXPECT_EQ(camera_pre.health.medium.received, 4u);
}

// Nodes take turns: the camera's, the second of seven, comes a quarter of a second after each whole one.
TEST_F(RunnerTest, HealthIsReportedOnceASecondAtItsTurn) {
  for (const auto& [scale, lasts] : {std::pair(1'000'000, ms(3'500)), {4'000'000, ms(875)}}) {
    Alone camera(*this, "camera", {.lasts = lasts, .scale_ppm = scale});
    camera.run();
    EXPECT_THAT(camera.reported_health,
                testing::ElementsAre(kOrigin + ms(250), kOrigin + ms(1250), kOrigin + ms(2250), kOrigin + ms(3250)));
    EXPECT_EQ(camera.out.accounts, 5) << "and at the end";
  }
}

// At twice the drive's time its turn comes 1.5 ms into a cycle, among its slots; the last of them is at 1.687
// ms.
TEST_F(RunnerTest, HealthIsReportedWhereThereIsRoomForIt) {
  Alone gateway(*this, "gateway", {.lasts = ms(400), .scale_ppm = 2'000'000});
  gateway.run();
  ASSERT_EQ(gateway.reported_health.size(), 1u);
  EXPECT_GT(gateway.reported_health[0], kOrigin + ms(625));
  EXPECT_GT(gateway.reported_health[0], gateway.action_point(62, 21) - us(500));
  EXPECT_LT(gateway.reported_health[0], gateway.action_point(62, 21) + us(500));
  EXPECT_EQ(gateway.waits_for_nothing, 0) << "until there is room it waits for what is due";
}

// A cycle that takes half a millisecond never has room.
TEST_F(RunnerTest, HealthIsPutOffByASecondAtMost) {
  Alone gateway(*this, "gateway", {.lasts = ms(18'000), .scale_ppm = 100'000});
  gateway.run();
  ASSERT_EQ(gateway.reported_health.size(), 1u);
  EXPECT_GE(gateway.reported_health[0], kOrigin + ms(1625));
  EXPECT_LT(gateway.reported_health[0], kOrigin + ms(1626));
  EXPECT_EQ(gateway.waits_for_nothing, 0);
}

// A node without own or received sync frames cannot correct its clock, and halts; its host restarts it at
// once.
TEST_F(RunnerTest, AHaltedControllerIsStartedAnew) {
  auto& parameters = *cluster_.nodes[index_of(id_of("gateway"))].flexray;
  parameters.pKeySlotUsedForSync = parameters.pKeySlotUsedForStartup = false;
  Alone gateway(*this, "gateway", {.lasts = ms(100)});
  gateway.run();
  const auto& states = gateway.out.states;
  const auto halted = static_cast<std::size_t>(std::find(states.begin(), states.end(), "halt") - states.begin());
  ASSERT_LT(halted, states.size());
  EXPECT_EQ(states.back(), "integration listen");
  for (std::size_t i = halted; i < states.size(); ++i)
    EXPECT_EQ(gateway.out.changes[i].local, gateway.out.changes[halted].local) << states[i];
}

// Noise delays a coldstart, unless the node had no power to receive it.
TEST_F(RunnerTest, ANodeWithoutPowerReceivesNothing) {
  const auto begins_cluster = [&](std::optional<Duration> noise) {
    Alone gateway(*this, "gateway", {.lasts = ms(60), .power_on = [](NodeId) {
                                       return std::optional(sim::engine::kFirstCycle + ms(10));
                                     }});
    if (noise) gateway.host.at(gateway.at(*noise), [&] { gateway.others_send_noise(us(100)); });
    gateway.run();
    return gateway.came_into("coldstart collision resolution").value_or(recording::records::Stamp{}).true_time;
  };
  const TrueTime silent = begins_cluster({});
  EXPECT_GT(silent, sim::engine::kFirstCycle + ms(10));
  EXPECT_EQ(begins_cluster(ms(9)), silent);
  EXPECT_GT(begins_cluster(ms(11)), silent);
}

// A startup frame lasts 65 us. A node in start-up takes it at its end, long before its own next event.
TEST_F(RunnerTest, AListeningNodeIsWokenUpByAFrame) {
  Alone gateway(*this, "gateway",
                {.lasts = ms(20), .power_on = [](NodeId) { return std::optional(sim::engine::kFirstCycle); }});
  gateway.host.at(gateway.at(ms(3)), [&] { gateway.others_send(1, 8, true); });
  gateway.run();
  const auto derived = gateway.came_into("initialise schedule");
  ASSERT_TRUE(derived.has_value());
  EXPECT_GT(derived->true_time, sim::engine::kFirstCycle + ms(3) + us(60));
  EXPECT_LT(derived->true_time, sim::engine::kFirstCycle + ms(3) + us(80));
}

// On such a medium it arrives immediately, with its length.
TEST_F(RunnerTest, ASymbolIsAsLongAsInTheDrive) {
  const auto first_symbol = [&](std::int64_t scale) {
    Alone gateway(*this, "gateway",
                  {.lasts = ms(30), .scale_ppm = scale, .power_on = [](NodeId) { return sim::engine::kFirstCycle; }});
    gateway.run();
    const auto lengths = gateway.received_symbols();
    EXPECT_FALSE(lengths.empty());
    return lengths.empty() ? Duration{} : lengths.front();
  };
  const Duration length = first_symbol(1'000'000);
  EXPECT_GT(length, us(3)) << "a collision avoidance symbol: some 40 bits of 100 ns";
  EXPECT_LE(std::abs((first_symbol(4'000'000) - length * 4).ns), 4) << "rounded to nanoseconds";
}

// It has used up its coldstart attempts, and listens. After 64 cycles its host restores them.
TEST_F(RunnerTest, AListeningNodeIsStartedAnewAfter64Cycles) {
  cluster_.flexray.gColdStartAttempts = 2;
  Alone gateway(*this, "gateway",
                {.lasts = ms(1'000), .power_on = [](NodeId) { return std::optional(sim::engine::kFirstCycle); }});
  gateway.run();
  const auto& states = gateway.out.states;
  const auto gave_up = std::find(states.begin(), states.end(), "integration listen") - states.begin();
  ASSERT_LT(gave_up + 1, static_cast<std::ptrdiff_t>(states.size()));
  const auto& changes = gateway.out.changes;
  const auto listened = static_cast<std::size_t>(gave_up);
  EXPECT_EQ(changes[listened + 1].local - changes[listened].local, ms(5) * 64);
  EXPECT_THAT(std::vector<std::string>(states.begin() + gave_up, states.end()), testing::Contains("coldstart listen"));
}

// The fusion begins at 1.8 ms. Its slot 4 is due 3.459 ms later, and then as late as the window allows.
TEST_F(RunnerTest, AStepThatComputesForTooLongMakesTheNextSlotLate) {
  const auto missed_after = [&](Duration computes) {
    Alone fusion(*this, "fusion", {.lasts = ms(10)});
    fusion.computes = computes;
    fusion.run();
    EXPECT_TRUE(fusion.out.ordered);
    return fusion.missed();
  };
  const Duration longest = ms(5) + us(3 * 84 + 7) - us(1800) + cluster_.arrival_window->late - TurnedHost::kShortest;
  EXPECT_THAT(missed_after(longest - us(1)), testing::IsEmpty());
  EXPECT_THAT(missed_after(longest + us(1)), testing::ElementsAre(SlotOfCycle{1, 4, 0}, SlotOfCycle{1, 4, 1}));
}

// The lateness of a plain thread beside it is reported along with its own.
TEST_F(RunnerTest, TheMachinesOwnLatenessIsReported) {
  Alone gateway(*this, "gateway", {.lasts = ms(10)});
  gateway.floor.add(us(70));
  gateway.floor.add(us(90));
  gateway.run();
  EXPECT_EQ(gateway.out.lateness[recording::records::LatenessOf::kFloor], (Recorded::Histogram{2, us(90)}));
}

}  // namespace
}  // namespace ttf::nodes::runner
