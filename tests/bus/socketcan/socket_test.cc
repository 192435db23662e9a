#include "bus/socketcan/socket.h"

#include <gtest/gtest.h>
#include <time.h>
#include <unistd.h>

#include <cstring>
#include <vector>

#include "bus/socketcan/flexray_on_can.h"
#include "tests/bus/socketcan/frames.h"
#include "tests/bus/socketcan/vcan.h"

namespace ttf::bus::socketcan {
namespace {

using schedules::model::Channel;
using SocketOnVcan = OnVcan;
using SocketOnOwnVcan = OwnVcan;

constexpr Duration kLong = Duration::milliseconds(1000);

canfd_frame can_fd(canid_t identifier, std::uint8_t length, std::uint8_t fill) {
  canfd_frame can{};
  can.can_id = identifier;
  can.len = length;
  can.flags = CANFD_BRS | CANFD_FDF;
  std::memset(can.data, fill, length);
  return can;
}

std::int64_t now_ns() {
  timespec now{};
  clock_gettime(CLOCK_REALTIME, &now);
  return std::int64_t{now.tv_sec} * 1'000'000'000 + now.tv_nsec;
}

// The next thing to receive, if it comes within a second.
Status next(Socket& socket, Received& received) {
  Status status = socket.receive(received);
  if (status != Status::kNothing) return status;
  socket.wait(kLong);
  return socket.receive(received);
}

TEST_F(SocketOnVcan, EveryFlexRayFrameReachesTheOthersOnceInOrderUnchanged) {
  Socket sender({.interface = kName, .filters = {}});
  Socket first({.interface = kName, .filters = {}}), second({.interface = kName, .filters = {}});
  EXPECT_EQ(first.shortage(), "");
  for (int words = 0; words <= 127; ++words) {
    const Bytes frame = drawn_frame(Channel::kA, 1 + words * 16, words % 64, words);
    const CanFrames can = frame_to_can(1 + words * 16, frame);
    for (const canfd_frame& one : can.all()) ASSERT_EQ(sender.send(one), Status::kDone);
  }
  for (Socket* receiver : {&first, &second}) {
    Reassembly channel(Channel::kA);
    std::int64_t before = 0;
    for (int words = 0; words <= 127; ++words) {
      Received received;
      Arrival arrival;
      do {
        ASSERT_EQ(next(*receiver, received), Status::kDone);
        EXPECT_GE(received.stamp_ns, before);
        before = received.stamp_ns;
        EXPECT_EQ(received.lost_before, 0u);
        arrival = channel.arrive(received.can);
      } while (arrival.outcome == Outcome::kFragment);
      ASSERT_EQ(arrival.outcome, Outcome::kComplete);
      EXPECT_EQ(bytes_of(arrival.frame), drawn_frame(Channel::kA, 1 + words * 16, words % 64, words));
    }
    Received more;
    EXPECT_EQ(receiver->receive(more), Status::kNothing);
    EXPECT_EQ(receiver->lost(), 0u);
  }
  Received own;
  EXPECT_EQ(sender.receive(own), Status::kNothing);  // a sender does not receive itself
}

TEST_F(SocketOnVcan, StampsAreWhenTheFrameWasThere) {
  Socket sender({.interface = kName, .filters = {}}), receiver({.interface = kName, .filters = {}});
  const std::int64_t before = now_ns();
  ASSERT_EQ(sender.send(can_fd(1, 8, 0)), Status::kDone);
  const std::int64_t after = now_ns();
  const timespec pause{.tv_sec = 0, .tv_nsec = 20'000'000};
  nanosleep(&pause, nullptr);
  Received received;
  ASSERT_EQ(next(receiver, received), Status::kDone);
  EXPECT_GE(received.stamp_ns, before);
  EXPECT_LE(received.stamp_ns, after);  // not when it was read
}

TEST_F(SocketOnVcan, ClassicFramesAreDistinctFromCanFd) {
  Socket sender({.interface = kName, .flexible_data_rate = false, .filters = {}});
  Socket receiver({.interface = kName, .filters = {}});
  canfd_frame classic = can_fd(5, 8, 0x11);
  classic.flags = 0;
  ASSERT_EQ(sender.send(classic), Status::kDone);
  Received received;
  ASSERT_EQ(next(receiver, received), Status::kDone);
  EXPECT_EQ(received.can.flags & CANFD_FDF, 0);
  EXPECT_EQ(received.can.len, 8);
  EXPECT_EQ(Reassembly(Channel::kA).arrive(received.can).outcome, Outcome::kForeign);
}

TEST_F(SocketOnVcan, FiltersLetThroughWhatMatches) {
  Socket sender({.interface = kName, .filters = {}});
  Socket receiver(
      {.interface = kName, .filters = {{0x100, CAN_EFF_FLAG | CAN_SFF_MASK}, {0x206, CAN_EFF_FLAG | 0x7fe}}});
  for (const canid_t identifier : {0x0ffu, 0x100u, 0x101u, 0x206u, 0x207u, 0x208u, 0x100u | CAN_EFF_FLAG})
    ASSERT_EQ(sender.send(can_fd(identifier, 8, 0)), Status::kDone);
  std::vector<canid_t> taken;
  for (Received received; receiver.receive(received) == Status::kDone;) taken.push_back(received.can.can_id);
  EXPECT_EQ(taken, (std::vector<canid_t>{0x100, 0x206, 0x207}));
}

// Without a reader, frames without room are counted, at the gap and at the end.
TEST_F(SocketOnVcan, FramesWithoutRoomAreCounted) {
  constexpr std::uint32_t kSent = 200, kAgain = 10;
  Socket sender({.interface = kName, .filters = {}});
  Socket receiver({.interface = kName, .receive_buffer_frames = 16, .filters = {}});
  std::uint8_t number = 0;
  for (std::uint32_t i = 0; i < kSent; ++i) ASSERT_EQ(sender.send(can_fd(1, 64, number++)), Status::kDone);
  std::uint32_t taken = 0;
  for (Received received; receiver.receive(received) == Status::kDone; ++taken) {
    EXPECT_EQ(received.can.data[0], taken);
    EXPECT_EQ(received.lost_before, 0u);
  }
  EXPECT_GE(taken, 16u);
  EXPECT_LT(taken, kSent);
  EXPECT_EQ(receiver.lost(), kSent - taken);
  // The first frame after the gap reports it.
  for (std::uint32_t i = 0; i < kAgain; ++i) ASSERT_EQ(sender.send(can_fd(1, 64, number++)), Status::kDone);
  for (std::uint32_t i = 0; i < kAgain; ++i) {
    Received received;
    ASSERT_EQ(next(receiver, received), Status::kDone);
    EXPECT_EQ(received.can.data[0], static_cast<std::uint8_t>(kSent + i));
    EXPECT_EQ(received.lost_before, i == 0 ? kSent - taken : 0u);
  }
  EXPECT_EQ(receiver.lost(), kSent - taken);
}

TEST_F(SocketOnVcan, TheReceiveBufferHoldsWhatItIsSaidTo) {
  constexpr int kFrames = 5000;
  Socket sender({.interface = kName, .filters = {}});
  Socket receiver({.interface = kName, .receive_buffer_frames = kFrames, .filters = {}});
  if (!receiver.shortage().empty()) GTEST_SKIP() << receiver.shortage();
  for (int i = 0; i < kFrames; ++i) ASSERT_EQ(sender.send(can_fd(1, 64, 0)), Status::kDone);
  int taken = 0;
  for (Received received; receiver.receive(received) == Status::kDone;) ++taken;
  EXPECT_EQ(taken, kFrames);
  EXPECT_EQ(receiver.lost(), 0u);
}

TEST_F(SocketOnVcan, ASmallerReceiveBufferIsReportedWithTheCommand) {
  if (geteuid() != 0) GTEST_SKIP() << "only root can be somebody else";
  ASSERT_EQ(seteuid(65534), 0);  // without CAP_NET_ADMIN
  const Socket receiver({.interface = kName, .receive_buffer_frames = 1'000'000, .filters = {}});
  ASSERT_EQ(seteuid(0), 0);
  EXPECT_EQ(receiver.shortage().rfind("vcan0: the receive buffer holds ", 0), 0u) << receiver.shortage();
  EXPECT_EQ(command_in(receiver.shortage()), "sysctl -w net.core.rmem_max=384000000");
}

// Earlier frames are still handed out. Then receivers and senders get the end.
TEST_F(SocketOnOwnVcan, AnInterfaceThatGoesDownIsAClearError) {
  ip("mtu 72 up");
  Socket sender({.interface = kName, .filters = {}}), receiver({.interface = kName, .filters = {}});
  for (std::uint8_t i = 0; i < 3; ++i) ASSERT_EQ(sender.send(can_fd(1, 8, i)), Status::kDone);
  EXPECT_EQ(receiver.failure(), "");
  ip("down");
  Received received;
  for (std::uint8_t i = 0; i < 3; ++i) {
    ASSERT_EQ(receiver.receive(received), Status::kDone);
    EXPECT_EQ(received.can.data[0], i);
  }
  EXPECT_EQ(receiver.receive(received), Status::kDown);
  EXPECT_EQ(receiver.failure(), "vcan97: the interface went down during the run: ip link set vcan97 up");
  EXPECT_EQ(sender.send(can_fd(1, 8, 0)), Status::kDown);
  ip("up");  // frames may have passed unseen: the error remains
  EXPECT_EQ(receiver.receive(received), Status::kDown);
  EXPECT_EQ(receiver.send(can_fd(1, 8, 0)), Status::kDown);
}

// A sleeping reader wakes up.
TEST_F(SocketOnOwnVcan, AnInterfaceThatIsRemovedWakesItsReader) {
  ip("mtu 72 up");
  Socket receiver({.interface = kName, .filters = {}});
  ASSERT_TRUE(run(std::string("(sleep 0.05; ip link del dev ") + kName + ") &"));
  const std::int64_t before = now_ns();
  receiver.wait(Duration::milliseconds(60'000));
  EXPECT_LT(now_ns() - before, 30'000'000'000);
  Received received;
  const Status status = receiver.receive(received);
  EXPECT_TRUE(status == Status::kDown || status == Status::kGone) << static_cast<int>(status);
  EXPECT_NE(receiver.failure(), "");
}

}  // namespace
}  // namespace ttf::bus::socketcan
