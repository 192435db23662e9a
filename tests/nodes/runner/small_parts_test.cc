// The runner's small parts: the drive's clock, a paced CAN, a sensor's wires.
#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "bus/wire/can_timing.h"
#include "bus/wire/strobe.h"
#include "nodes/runner/drive_clock.h"
#include "nodes/runner/paced_can.h"
#include "schedules/file/loader.h"

namespace ttf::nodes::runner {
namespace {

TEST(DriveClock, StretchesTheDrive) {
  const DriveClock clock(bus::ports::MachineTime{1'000}, 2'500'000);
  EXPECT_EQ(clock.drive_time(bus::ports::MachineTime{1'000}).ns, 0);
  EXPECT_EQ(clock.drive_time(bus::ports::MachineTime{1'000 + 250}).ns, 100);
  EXPECT_EQ(clock.machine_time(TrueTime{100}).ns, 1'250);
  EXPECT_EQ(clock.drive_time(bus::ports::MachineTime{0}).ns, -400);
}

TEST(DriveClock, AnInstantOfTheDriveIsReachedAtItsMachineTimeAndNotBefore) {
  for (const std::int64_t scale : {100'000, 999'999, 1'000'000, 1'000'003, 7'000'000, 1'000'000'000}) {
    const DriveClock clock(bus::ports::MachineTime{123'456'789}, scale);
    for (const std::int64_t ns : {std::int64_t{-7}, std::int64_t{0}, std::int64_t{1}, std::int64_t{999'999'937},
                                  std::int64_t{86'400'000'000'007}}) {
      const bus::ports::MachineTime at = clock.machine_time(TrueTime{ns});
      EXPECT_GE(clock.drive_time(at).ns, ns) << scale;
      EXPECT_LT(clock.drive_time(at - Duration{1}).ns, ns) << scale;
    }
  }
}

// A turn every 10 ns, 3 after the origin at 1000: at ..., 993, 1003, 1013, ...; regardless of the drive's
// scale.
TEST(DriveClock, TurnsAreWhereTheyAreFromTheOrigin) {
  const DriveClock clock(bus::ports::MachineTime{1'000}, 2'500'000);
  const auto next = [&](std::int64_t now) {
    return clock.next_turn(Duration{10}, Duration{3}, bus::ports::MachineTime{now}).ns;
  };
  EXPECT_EQ(next(1'000), 1'003);
  EXPECT_EQ(next(1'002), 1'003);
  EXPECT_EQ(next(1'003), 1'013);
  EXPECT_EQ(next(992), 993);
  EXPECT_EQ(next(993), 1'003);
  EXPECT_EQ(next(-5), 3);
  EXPECT_EQ(next(86'400'000'000'000), 86'400'000'000'003);
}

class PacedCanTest : public testing::Test {
 protected:
  recording::records::Stamp now() const { return {now_, {}, {}, NodeId{}}; }
  bus::wire::CanFrameTimes times(std::uint32_t identifier) const {
    return bus::wire::can_frame_times(cluster_.can_buses[0], identifier, data_);
  }
  const schedules::model::Cluster cluster_ =
      schedules::file::load_cluster(TTF_SOURCE_DIR "/schedules/paper_synchronised.yaml");
  TrueTime now_{1'000};
  PacedCan can_{cluster_, 0, 4, [this] { return now(); }};
  const std::array<std::byte, 64> data_{};
};

TEST_F(PacedCanTest, FramesLeaveWhenABusWouldHaveBroughtThem) {
  can_.send({256, true, data_});
  can_.send({257, true, data_});
  const bus::wire::CanFrameTimes first = times(256), second = times(257);
  EXPECT_EQ(can_.next(), now_ + first.accepted);
  now_ = TrueTime{9'000'000};  // late: those behind it are no later for it
  const auto one = can_.leave();
  EXPECT_EQ(one.frame.identifier, 256u);
  EXPECT_EQ(one.sent.start.true_time, TrueTime{1'000});
  EXPECT_EQ(one.sent.end.true_time, TrueTime{1'000} + first.accepted);
  EXPECT_EQ(can_.next(), TrueTime{1'000} + first.idle + second.accepted);  // its intermission comes between
  const auto two = can_.leave();
  EXPECT_EQ(two.sent.start.true_time, TrueTime{1'000} + first.idle);
  EXPECT_EQ(two.frame.data.size(), 64u);
  can_.send({258, true, data_});  // the bus had been idle
  EXPECT_EQ(can_.next(), now_ + times(258).accepted);
}

TEST_F(PacedCanTest, FramesWithoutRoomAreCounted) {
  for (int i = 0; i < 6; ++i) can_.send({256, true, data_});
  EXPECT_EQ(can_.dropped(), 2u);
  for (int i = 0; i < 4; ++i) can_.leave();
  EXPECT_EQ(can_.next().ns, std::numeric_limits<std::int64_t>::max());
}

TEST(SensorLines, AStrobeCarriesItsNumber) {
  for (const std::uint32_t number : {0u, 1u, 0x01020304u, 0xFFFFFFFFu})
    EXPECT_EQ(bus::wire::strobe_sequence(bus::wire::strobe_data(number)), number);
  EXPECT_EQ(bus::wire::strobe_data(0x01020304u)[0], std::byte{1});
  EXPECT_FALSE(bus::wire::strobe_sequence(std::array<std::byte, 3>{}));
  EXPECT_NE(schedules::model::strobe_identifier(SensorId{1}), schedules::model::trigger_identifier(SensorId{0}));
}

}  // namespace
}  // namespace ttf::nodes::runner
