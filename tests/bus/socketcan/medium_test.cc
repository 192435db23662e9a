// Particulars of the real-time medium on SocketCAN: its counts, its reports of late departures, and
// interfaces that go away. Its laws: live_laws_test.cc.
#include "bus/socketcan/medium.h"

#include <gtest/gtest.h>
#include <linux/can/error.h>
#include <linux/net_tstamp.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstring>
#include <fstream>
#include <iterator>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "core/errors.h"
#include "recording/records/records.h"
#include "tests/bus/socketcan/frames.h"
#include "tests/bus/socketcan/vcan.h"
#include "tests/support/allocation_counter.h"

namespace ttf::bus::socketcan {
namespace {

using ports::LiveArrival;
using ports::LiveStatus;
using ports::MachineTime;
using schedules::model::Channel;

// On channel A, on B, and on a classic CAN.
class LiveOnVcan : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!vcans_.missing().empty()) GTEST_SKIP() << vcans_.missing();
  }
  LiveOptions options(int receive_buffer_frames = 1024) const {
    return {.channels = {vcans_[0], vcans_[1]},
            .cans = {{vcans_[2], false}},
            .receive_buffer_frames = receive_buffer_frames};
  }
  Socket stranger(std::size_t line) const { return Socket({.interface = vcans_[line], .filters = {}}); }
  static ports::LiveSignal signal(const Bytes& frame, int slot, bool states_late = false) {
    return {.channel = Channel::kA, .slot = slot, .bytes = frame, .states_late = states_late};
  }
  // The next arrival within a second.
  static std::optional<LiveArrival> next(SocketCanMedium& medium) {
    for (int i = 0; i < 1000; ++i) {
      if (auto arrival = medium.receive()) return arrival;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return {};
  }

  Vcans vcans_{{"vcan93", "vcan94", "vcan95"}};
};

canfd_frame can_of(canid_t identifier, std::uint8_t length, std::uint8_t flags) {
  canfd_frame can{};
  can.can_id = identifier;
  can.len = length;
  can.flags = flags;
  return can;
}

// Only sleeping takes time there (tools/test_bed.sh).
bool in_virtual_time() {
  std::ifstream stream("/proc/cmdline");
  const std::string words{std::istreambuf_iterator<char>(stream), {}};
  return words.find("time-travel=inf-cpu") != std::string::npos;
}

// The sender had not sent it when it was due: to the nanosecond, where instants are that precise.
TEST_F(LiveOnVcan, AFollowUpSaysHowLateTheFrameLeft) {
  SocketCanMedium sender(options()), receiver(options());
  for (const std::int64_t late_ns : {0, 1'000'000, 123'456'789, -5'000'000, 2'000'000'000}) {
    const Bytes frame = drawn_frame(Channel::kA, 9, 33, 20);
    const MachineTime due = ports::host_now() - Duration::nanoseconds(late_ns), begin = ports::host_now();
    ASSERT_EQ(sender.send(signal(frame, 9, true), due), LiveStatus::kDone);
    const MachineTime end = ports::host_now();
    const auto arrival = next(receiver);
    ASSERT_TRUE(arrival);
    ASSERT_EQ(arrival->kind, LiveArrival::Kind::kFlexRay);
    EXPECT_FALSE(arrival->late);
    const MachineTime at = arrival->at;
    EXPECT_FALSE(sender.receive());  // at the latest now its frame's confirmation is there
    const auto follow_up = next(receiver);
    ASSERT_TRUE(follow_up && follow_up->late);
    EXPECT_EQ(follow_up->kind, LiveArrival::Kind::kFollowUp);
    EXPECT_EQ(follow_up->signal.channel, Channel::kA);
    EXPECT_EQ(follow_up->signal.slot, 9);
    EXPECT_EQ(follow_up->cycle_counter, 33);
    EXPECT_GE(*follow_up->late, begin - due);
    EXPECT_LE(*follow_up->late, end - due);
    if (in_virtual_time()) {
      EXPECT_EQ(follow_up->late->ns, (at - due).ns);
    }
  }
  EXPECT_EQ(sender.counts().sent, 5u);
  EXPECT_EQ(receiver.counts().received, 5u);  // follow-ups do not count
}

// It follows the frame without further calls by the sender if the echo comes next.
TEST_F(LiveOnVcan, AFollowUpIsSentAtOnce) {
  if (!in_virtual_time()) GTEST_SKIP() << "on a busy machine the kernel may take its time for the echo";
  SocketCanMedium sender(options()), receiver(options());
  const Bytes frame = drawn_frame(Channel::kA, 9, 33, 20);
  std::size_t follow_up = 0;
  for (int i = 0; i < 20; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    ASSERT_EQ(sender.send(signal(frame, 9, true), ports::host_now()), LiveStatus::kDone);
    while (const auto arrival = receiver.receive()) follow_up += arrival->kind == LiveArrival::Kind::kFollowUp;
  }
  EXPECT_EQ(follow_up, 20u);
}

// Another member's frame is ahead of the echo: it is handed over first, and stays readable until then (L8).
TEST_F(LiveOnVcan, AFollowUpWaitsForWhatIsStillToBeReceived) {
  SocketCanMedium sender(options()), receiver(options());
  const Bytes others = drawn_frame(Channel::kA, 2, 33, 20), own = drawn_frame(Channel::kA, 9, 33, 20);
  ASSERT_EQ(receiver.send(signal(others, 2), {}), LiveStatus::kDone);
  const MachineTime due = ports::host_now();
  ASSERT_EQ(sender.send(signal(own, 9, true), due), LiveStatus::kDone);
  const MachineTime left = ports::host_now();
  ASSERT_TRUE(next(receiver));
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  EXPECT_FALSE(receiver.receive());
  const auto arrival = next(sender);
  ASSERT_TRUE(arrival);
  EXPECT_EQ(arrival->signal.slot, 2);
  EXPECT_EQ(bytes_of(arrival->signal.bytes), others);
  EXPECT_FALSE(sender.receive());  // its own it keeps to itself
  const auto follow_up = next(receiver);
  ASSERT_TRUE(follow_up && follow_up->late);
  EXPECT_LE(*follow_up->late, left - due);  // when it left, not when that was reported
}

TEST_F(LiveOnVcan, OnlyFramesThatStateItAreFollowedUp) {
  SocketCanMedium sender(options()), receiver(options());
  const Bytes frame = drawn_frame(Channel::kA, 9, 33, 20);
  ASSERT_EQ(sender.send(signal(frame, 9, false), {}), LiveStatus::kDone);
  ASSERT_EQ(sender.send({.channel = Channel::kA, .signal = ports::Signal::kCas, .duration = {5'700}, .bytes = {}}, {}),
            LiveStatus::kDone);
  const MachineTime long_ago = ports::host_now() - Duration::milliseconds(3'000);  // too late for a follow-up
  ASSERT_EQ(sender.send(signal(frame, 9, true), long_ago), LiveStatus::kDone);
  for (int i = 0; i < 3; ++i) {
    const auto arrival = next(receiver);
    ASSERT_TRUE(arrival) << i;
    EXPECT_EQ(arrival->kind, LiveArrival::Kind::kFlexRay) << i;
    EXPECT_FALSE(sender.receive());
  }
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  EXPECT_FALSE(sender.receive());
  EXPECT_FALSE(receiver.receive());
}

// Strangers' frames may bear any stamp: a queue's transmission time, for one.
TEST_F(LiveOnVcan, NothingArrivesInTheFuture) {
  SocketCanMedium receiver(options());
  Socket socket = stranger(0);
  const sock_txtime with{.clockid = CLOCK_MONOTONIC, .flags = 0};
  ASSERT_EQ(setsockopt(socket.descriptor(), SOL_SOCKET, SO_TXTIME, &with, sizeof with), 0);
  canfd_frame can = symbol_to_can(Channel::kA, ports::Signal::kCas, Duration::nanoseconds(5'700));
  iovec place{.iov_base = &can, .iov_len = CANFD_MTU};
  alignas(cmsghdr) std::array<std::byte, CMSG_SPACE(sizeof(std::uint64_t))> control{};
  msghdr message{};
  message.msg_iov = &place;
  message.msg_iovlen = 1;
  message.msg_control = control.data();
  message.msg_controllen = control.size();
  cmsghdr* const head = CMSG_FIRSTHDR(&message);
  head->cmsg_level = SOL_SOCKET;
  head->cmsg_type = SCM_TXTIME;
  head->cmsg_len = CMSG_LEN(sizeof(std::uint64_t));
  const std::uint64_t year_2255 = 9'000'000'000'000'000'000;
  std::memcpy(CMSG_DATA(head), &year_2255, sizeof year_2255);
  const MachineTime begin = ports::host_now();
  ASSERT_EQ(sendmsg(socket.descriptor(), &message, 0), static_cast<ssize_t>(CANFD_MTU));
  const auto arrival = next(receiver);
  const MachineTime end = ports::host_now();
  ASSERT_TRUE(arrival);
  EXPECT_GE(arrival->at, begin);
  EXPECT_LE(arrival->at, end);
}

// As cangen writes them: classic and FD, 29 bits, remote and error frames. On a private CAN an error frame is a report
// of the controller.
TEST_F(LiveOnVcan, ForeignFramesAreCountedAndNotHandedOver) {
  SocketCanMedium medium(options());
  Socket on_a = stranger(0), on_can = stranger(2);
  const std::vector<canfd_frame> never_ours{can_of(5, 8, CANFD_FDF) /* of zeros: malformed */,
                                            can_of(5, 8, 0),
                                            can_of(5 | CAN_RTR_FLAG, 8, 0),
                                            can_of(5 | CAN_EFF_FLAG, 8, 0),
                                            can_of(5 | CAN_EFF_FLAG, 8, CANFD_FDF),
                                            can_of(CAN_ERR_FLAG | CAN_ERR_BUSOFF, 8, 0)};
  for (const canfd_frame& can : never_ours) {
    ASSERT_EQ(on_a.send(can), Status::kDone);
    if (can.can_id != 5) {
      ASSERT_EQ(on_can.send(can), Status::kDone);
    }
  }
  const auto report = next(medium);
  ASSERT_TRUE(report && report->kind == LiveArrival::Kind::kCanReport);
  EXPECT_EQ(report->can_bus, 0u);
  EXPECT_EQ(report->report.state, recording::records::CanState::kBusOff);
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  EXPECT_FALSE(medium.receive());
  EXPECT_EQ(medium.counts().foreign, 5u + 3u);
  EXPECT_EQ(medium.counts().malformed, 1u);
  EXPECT_EQ(medium.counts().received, 0u);
  EXPECT_EQ(medium.counts().lost, 0u);
  EXPECT_EQ(medium.failure(), "");
}

// The controller judges CAN FD frames on that CAN, so it has to get them.
TEST_F(LiveOnVcan, EveryDataFrameOfAPrivateCanIsHandedOver) {
  SocketCanMedium medium(options());
  Socket socket = stranger(2);
  ASSERT_EQ(socket.send(can_of(0x7ff, 3, 0)), Status::kDone);
  ASSERT_EQ(socket.send(can_of(0, 12, CANFD_FDF)), Status::kDone);
  ASSERT_EQ(socket.send(can_of(1, 13, CANFD_FDF)), Status::kDone);  // a length that CAN FD has not
  const auto classic = next(medium);
  ASSERT_TRUE(classic && classic->kind == LiveArrival::Kind::kCan);
  EXPECT_EQ(classic->can_bus, 0u);
  EXPECT_EQ(classic->can.identifier, 0x7ffu);
  EXPECT_FALSE(classic->can.flexible_data_rate);
  EXPECT_EQ(classic->can.data.size(), 3u);
  const auto flexible = next(medium);
  ASSERT_TRUE(flexible && flexible->kind == LiveArrival::Kind::kCan);
  EXPECT_TRUE(flexible->can.flexible_data_rate);
  EXPECT_EQ(flexible->can.data.size(), 12u);
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  EXPECT_FALSE(medium.receive());
  EXPECT_EQ(medium.counts().malformed, 1u);
  EXPECT_EQ(medium.counts().received, 2u);
}

TEST_F(LiveOnVcan, FramesWithoutRoomAreCountedAsLost) {
  SocketCanMedium sender(options()), receiver(options(16));
  const Bytes frame = drawn_frame(Channel::kA, 9, 33, 28);
  constexpr std::uint64_t kSent = 300;
  for (std::uint64_t i = 0; i < kSent; ++i) ASSERT_EQ(sender.send(signal(frame, 9), {}), LiveStatus::kDone);
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  std::uint64_t received = 0;
  while (receiver.receive()) ++received;
  EXPECT_GE(received, 16u);
  EXPECT_LT(received, kSent);
  EXPECT_EQ(receiver.counts().received, received);
  EXPECT_EQ(receiver.counts().lost, kSent - received);
  EXPECT_EQ(sender.counts().lost, 0u);
}

// A begun frame is lost, a fragment without a frame is malformed.
TEST_F(LiveOnVcan, FragmentsThatMakeNoFrameAreCounted) {
  SocketCanMedium medium(options());
  Socket socket = stranger(0);
  const CanFrames can = frame_to_can(70, drawn_frame(Channel::kA, 70, 1, 60));
  ASSERT_EQ(can.count, 3u);
  ASSERT_EQ(socket.send(can.frames[0]), Status::kDone);
  ASSERT_EQ(socket.send(can.frames[2]), Status::kDone);
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  EXPECT_FALSE(medium.receive());
  EXPECT_EQ(medium.counts().lost, 1u);
  EXPECT_EQ(medium.counts().malformed, 1u);
}

// While one line is flooded.
TEST_F(LiveOnVcan, EveryLineHasItsTurn) {
  SocketCanMedium sender(options()), receiver(options(2048));
  const Bytes frame = drawn_frame(Channel::kA, 9, 33, 4);
  for (int i = 0; i < 1000; ++i) ASSERT_EQ(sender.send(signal(frame, 9), {}), LiveStatus::kDone);
  ASSERT_EQ(sender.send_can(0, {.identifier = 1, .flexible_data_rate = false, .data = {}}), LiveStatus::kDone);
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  int before = 0;
  while (const auto arrival = receiver.receive()) {
    if (arrival->kind == LiveArrival::Kind::kCan) break;
    ++before;
  }
  EXPECT_LT(before, 100);
}

TEST_F(LiveOnVcan, ANodeIsOnlyOnItsOwnLines) {
  SocketCanMedium on_b({.channels = {"", vcans_[1]}, .cans = {{}}, .receive_buffer_frames = 64}), on_all(options());
  EXPECT_EQ(on_b.descriptor(0), -1);
  EXPECT_GE(on_b.descriptor(1), 0);
  EXPECT_EQ(on_b.descriptor(2), -1);
  const Bytes frame = drawn_frame(Channel::kB, 9, 33, 4);
  ASSERT_EQ(on_b.send({.channel = Channel::kB, .slot = 9, .bytes = frame}, {}), LiveStatus::kDone);
  const auto arrival = next(on_all);
  ASSERT_TRUE(arrival);
  EXPECT_EQ(arrival->signal.channel, Channel::kB);
  EXPECT_DEATH(on_b.send_can(0, {}), "this node is not on it");
}

// Frames of the other lines still arrive; earlier ones are handed over.
TEST_F(LiveOnVcan, AnInterfaceThatGoesDownIsAFailure) {
  SocketCanMedium sender(options()), receiver(options());
  const Bytes frame = drawn_frame(Channel::kA, 9, 33, 4);
  ASSERT_EQ(sender.send(signal(frame, 9), {}), LiveStatus::kDone);
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  ASSERT_TRUE(run("ip link set " + vcans_[0] + " down"));
  const std::int64_t before = support::allocations();
  const auto arrival = receiver.receive();
  ASSERT_TRUE(arrival);
  EXPECT_EQ(arrival->signal.slot, 9);
  EXPECT_FALSE(receiver.receive());
  const LiveStatus status = sender.send(signal(frame, 9), {});
  EXPECT_EQ(support::allocations(), before);  // not even for the sentence
  EXPECT_EQ(status, LiveStatus::kFailed);
  const std::string said = "vcan93: the interface went down during the run: ip link set vcan93 up";
  EXPECT_EQ(receiver.failure(), said);
  EXPECT_EQ(sender.failure(), said);
  EXPECT_EQ(sender.counts().sent, 1u);
  ASSERT_EQ(sender.send_can(0, {.identifier = 5, .flexible_data_rate = false, .data = {}}), LiveStatus::kDone);
  const auto other = next(receiver);
  ASSERT_TRUE(other && other->kind == LiveArrival::Kind::kCan);
  // Frames may have passed unseen, so the failure remains.
  ASSERT_TRUE(run("ip link set " + vcans_[0] + " up"));
  EXPECT_EQ(sender.send(signal(frame, 9), {}), LiveStatus::kFailed);
  EXPECT_EQ(receiver.failure(), said);
}

TEST_F(LiveOnVcan, AnInterfaceThatIsRemovedIsAFailure) {
  SocketCanMedium medium(options());
  ASSERT_TRUE(run("ip link set " + vcans_[2] + " down && ip link del dev " + vcans_[2]));
  EXPECT_FALSE(medium.receive());
  EXPECT_FALSE(medium.receive());
  EXPECT_EQ(medium.send_can(0, {}), LiveStatus::kFailed);
  EXPECT_EQ(medium.failure().rfind("vcan95: the interface ", 0), 0u) << medium.failure();
  EXPECT_NE(medium.failure().find(": ip link "), std::string::npos) << medium.failure();
}

TEST_F(LiveOnVcan, SmallerReceiveBuffersAreReportedOneByOne) {
  ASSERT_EQ(seteuid(65534), 0);  // without CAP_NET_ADMIN
  const SocketCanMedium medium(options(1'000'000));
  ASSERT_EQ(seteuid(0), 0);
  ASSERT_EQ(medium.shortages().size(), 3u);
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_EQ(medium.shortages()[i].rfind(vcans_[i] + ": the receive buffer holds ", 0), 0u) << medium.shortages()[i];
  EXPECT_TRUE(SocketCanMedium(options()).shortages().empty());
}

TEST_F(LiveOnVcan, TwoLinesHaveTwoInterfaces) {
  LiveOptions options{.channels = {vcans_[0], vcans_[0]}, .cans = {}};
  try {
    const SocketCanMedium medium(options);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "vcan93: carries two lines: each line needs an interface of its own");
  }
}

// On any machine.
TEST(SocketCanMediumWithout, AnInterfaceIsAClearError) {
  const std::string problem = interface_problem("vcan98", interface_state("vcan98"), true);
  ASSERT_NE(problem, "");
  try {
    const SocketCanMedium medium({.channels = {"vcan98", ""}, .cans = {}});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(std::string(error.what()), "vcan98: " + problem);
  }
}

}  // namespace
}  // namespace ttf::bus::socketcan
