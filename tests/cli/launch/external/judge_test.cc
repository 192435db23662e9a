// A real node's frames against the schedule: camera_pre of the paper's cluster, with slot 2 on both channels in every cycle.
// Its cluster runs 1000 ppm slower than the machine's clock.
#include "cli/launch/external/judge.h"

#include <gtest/gtest.h>

#include "bus/wire/flexray_frame.h"
#include "bus/wire/pdu_codec.h"
#include "cli/launch/external/account.h"
#include "cli/launch/external/in_order.h"
#include "schedules/check/real_time_rules.h"
#include "schedules/file/loader.h"

namespace ttf::cli::launch::external {
namespace {

using bus::ports::MachineTime;
using bus::ports::ReceivedFrame;
using schedules::model::Channel;

constexpr MachineTime kBegin{7'000'000'000};
constexpr Duration kCycle = Duration::microseconds(5'005);
constexpr Duration us(std::int64_t count) { return Duration::microseconds(count); }

schedules::model::Cluster paper() {
  return schedules::file::load_cluster(TTF_SOURCE_DIR "/schedules/paper_synchronised.yaml");
}

struct Judging : testing::Test {
  explicit Judging(schedules::model::Cluster of = paper(),
                   schedules::model::Channels channels = schedules::model::Channels::kAB)
      : cluster(std::move(of)),
        judge(cluster, {*cluster.find_node("camera_pre")}, schedules::check::kTimeScaleOne, channels) {}

  const schedules::model::Cluster cluster;
  Judge judge;
  InOrder in_order;
  Duration wobble{};           // the cluster's clock is off by it
  bool in_line_order = false;  // the frames of a line in one go, until hand_over()

  static MachineTime start_of(std::int64_t cycle) { return kBegin + kCycle * cycle; }
  static Duration action_point(int slot) { return us((slot - 1) * 84 + 7); }

  struct Frame {
    int slot = 2;
    Channel channel = Channel::kA;
    bool sync = true;
    int words = 28;
    int spoil = -1;  // this byte
    std::uint8_t counter_off = 0;
  };
  void frame(std::int64_t cycle, Duration behind, const Frame& how) {
    bus::wire::FrameHeader header;
    header.frame_id = static_cast<std::uint16_t>(how.slot);
    header.cycle = static_cast<std::uint8_t>((cycle + how.counter_off) % 64);
    header.sync = header.startup = how.sync;
    const std::vector<std::byte> payload(2 * static_cast<std::size_t>(how.words));
    std::array<std::byte, bus::wire::kMaxFrameBytes> bytes{};
    const std::size_t size = bus::wire::encode_frame(header, how.channel, payload, bytes);
    if (how.spoil >= 0) bytes[static_cast<std::size_t>(how.spoil)] ^= std::byte{1};
    ReceivedFrame received;
    received.line = bus::ports::line_of(how.channel);
    received.slot = how.slot;
    received.at = start_of(cycle) + action_point(how.slot) + behind + wobble;
    received.bytes = std::span(bytes).first(size);
    take(received);
  }
  void ours(std::int64_t cycle, Duration behind = {}) { frame(cycle, behind, Frame{}); }
  void ours_like(std::int64_t cycle, const Frame& how) { frame(cycle, {}, how); }

  void take(const ReceivedFrame& received) {
    if (in_line_order)
      in_order.add(received);
    else
      judge.receive(received);
  }
  void hand_over() {
    in_order.hand_over([&](const ReceivedFrame& received) { judge.receive(received); });
  }

  // The others' sync frames of a cycle, each late by another time, which its follow-up states.
  void others(std::int64_t cycle, Duration out_of_step = {}, Channel channel = Channel::kA) {
    for (const int slot : {1, 3, 4, 5}) {
      const Duration late = us(70 * slot);
      frame(cycle, late + (slot == 1 ? out_of_step : Duration{}), {.slot = slot, .channel = channel});
      ReceivedFrame follow_up;
      follow_up.form = ReceivedFrame::Form::kFollowUp;
      follow_up.slot = slot;
      follow_up.cycle_counter = static_cast<std::uint8_t>(cycle % 64);
      follow_up.late = late;
      follow_up.line = bus::ports::line_of(channel);
      follow_up.at = start_of(cycle) + action_point(slot) + late + wobble + us(1);
      take(follow_up);
    }
  }
  Counts counts() const { return judge.counts(0); }
};

// Without the trigger, and with channel A alone: frames of slot 2 there are all that may be missing.
struct JudgingASlot : Judging {
  JudgingASlot() : Judging(without_trigger(), schedules::model::Channels::kA) {}
  static schedules::model::Cluster without_trigger() {
    schedules::model::Cluster cluster = paper();
    for (schedules::model::Sensor& sensor : cluster.sensors) sensor.scheduled = false;
    return cluster;
  }
};

TEST_F(JudgingASlot, FollowsTheClustersClock) {
  judge.begin(kBegin);
  for (int cycle = 0; cycle < 1'000; ++cycle) {  // the last one 5 ms behind the schedule
    ours(cycle, us(cycle % 2 == 0 ? -90 : 490));
    others(cycle);
  }
  EXPECT_EQ(counts().in_window, 1'000u);
  EXPECT_EQ(status_text({"camera_pre", counts(), {}, {}}), "sending, 1000 in window");
}

TEST_F(Judging, ColdStartsHaveNoGivenBegin) {
  ours(5);  // it has no place yet
  for (int cycle = 5; cycle < 10; ++cycle) others(cycle);
  ours(10, us(10));
  EXPECT_EQ(counts().early, 1u);
  EXPECT_EQ(counts().in_window, 1u);
}

TEST_F(Judging, ANodeOutOfStepMovesNothing) {
  judge.begin(kBegin);
  for (int cycle = 0; cycle < 20; ++cycle) {
    ours(cycle);
    others(cycle, us(1'700));
  }
  EXPECT_EQ(counts().in_window, 20u);
}

TEST_F(JudgingASlot, CountsEarlyLateAndMissing) {
  judge.begin(kBegin);
  for (int cycle = 0; cycle < 12; ++cycle) {
    if (cycle == 3) ours(cycle, us(-150));
    if (cycle == 4) ours(cycle, us(700));
    if (cycle < 3 || cycle == 7) ours(cycle);
    others(cycle);
  }
  EXPECT_EQ(counts().in_window, 4u);
  EXPECT_EQ(counts().early, 1u);
  EXPECT_EQ(counts().late, 1u);
  EXPECT_EQ(counts().missing, 2u + 3u);  // 5, 6; 8 to 10: cycle 11 is not over
  EXPECT_EQ(wrongs_text({{"camera_pre", counts(), {}, {}}}), "camera_pre: 1 early, 1 late, 5 missing");
}

TEST_F(Judging, AFrameOfTheNextCycleIsEarlyAndOneOfTheLastIsLate) {
  judge.begin(kBegin);
  for (int cycle = 0; cycle < 4; ++cycle) others(cycle);
  ours(4, us(-2'000));  // in cycle 3
  ours(5, us(5'500));   // in cycle 6
  EXPECT_EQ(counts().early, 1u);
  EXPECT_EQ(counts().late, 1u);
}

TEST_F(Judging, BeforeTheFirstCycleAllIsEarly) {
  judge.begin(kBegin);
  ours_like(-3, {.counter_off = 64});
  EXPECT_EQ(counts().early, 1u);
}

// The frame of a cycle counts once.
TEST_F(JudgingASlot, ABrokenFrameIsNotMissing) {
  judge.begin(kBegin);
  for (int cycle = 0; cycle < 40; ++cycle) {  // the first is broken, and one behind others
    ours_like(cycle, {.spoil = cycle % 20 == 0 ? 20 : -1});
    others(cycle);
  }
  EXPECT_EQ(counts().in_window, 38u);
  EXPECT_EQ(counts().all_malformed(), 2u);
  EXPECT_EQ(counts().missing, 0u);
}

TEST_F(Judging, FramesNeverSentAreMissing) {
  judge.begin(kBegin);
  for (int cycle = 0; cycle < 5; ++cycle) others(cycle);
  EXPECT_EQ(counts().missing, 0u);  // it is still waiting
  for (int cycle = 5; cycle < 600; ++cycle) {
    ours(cycle);
    others(cycle);
  }
  EXPECT_EQ(counts().in_window, 595u);
  EXPECT_EQ(counts().missing, 593u + 74u);  // on channel B in 6 to 598; triggers in 9, 17 to 593
  EXPECT_EQ(wrongs_text({{"camera_pre", counts(), {}, {}, judge.never_received(0)}, {"camera", counts(), {}, {}}}),
            "camera_pre: 667 missing, camera_objects never heard; camera: 667 missing");
  ours_like(600, {.channel = Channel::kB});
  others(600);
  EXPECT_EQ(counts().missing, 594u + 74u);  // it begins now
}

// A listener receives 20 cycles of channel A, and then those of B. One long cycle puts the cycle 18 before it 36 us off,
// and the node's frames come 20 us before their window ends.
TEST_F(Judging, ChannelsMayComeOneAfterTheOther) {
  judge.begin(kBegin);
  in_line_order = true;
  for (int batch = 0; batch < 30; ++batch) {
    for (const Channel channel : schedules::model::kBothChannels)
      for (int cycle = 20 * batch; cycle < 20 * (batch + 1); ++cycle) {
        wobble = us(cycle % 20 == 18 ? 2 : 0);
        frame(cycle, us(480), {.channel = channel});
        others(cycle, {}, channel);
      }
    hand_over();
  }
  EXPECT_EQ(counts().in_window, 2u * 600u);
  EXPECT_EQ(counts().early + counts().late, 0u);
}

TEST(InOrder, ALineKeepsItsOrder) {
  InOrder in_order;
  std::array<std::byte, 1> bytes{};
  const auto add = [&](bus::ports::Line line, std::int64_t at, int name) {
    bytes[0] = static_cast<std::byte>(name);
    ReceivedFrame received;
    received.line = line;
    received.at = {at};
    received.bytes = bytes;
    in_order.add(received);
  };
  const auto names = [&] {
    std::vector<int> all;
    in_order.hand_over([&](const ReceivedFrame& received) { all.push_back(std::to_integer<int>(received.bytes[0])); });
    return all;
  };
  add(0, 10, 1);
  add(0, 40, 4);
  add(0, 39, 5);  // the clock was read anew
  add(1, 20, 2);
  add(1, 30, 3);
  add(1, 50, 6);
  EXPECT_EQ(names(), (std::vector<int>{1, 2, 3, 4, 5, 6}));
  add(1, 5, 7);
  EXPECT_EQ(names(), std::vector<int>{7});
}

TEST_F(Judging, ReportsHowAFrameIsMalformed) {
  judge.begin(kBegin);
  others(0);
  ours_like(0, {.spoil = 20});    // frame CRC
  ours_like(1, {.sync = false});  // a key slot's frame is a sync frame
  ours_like(2, {.words = 20});
  ours_like(3, {.counter_off = 9});
  ours_like(4, {});
  ours_like(4, {});                        // again
  ours_like(4, {.channel = Channel::kB});  // another frame
  ReceivedFrame received;
  received.form = ReceivedFrame::Form::kMalformed;
  received.slot = 2;
  judge.receive(received);
  received.slot = 30;  // another node's
  judge.receive(received);
  const Counts all = counts();
  EXPECT_EQ(all.in_window, 2u);
  EXPECT_EQ(all.malformed, (std::array<std::uint64_t, kMalformedKinds>{1, 1, 3, 0, 0, 1, 0}));
  EXPECT_EQ(all.all_malformed(), 6u);
  EXPECT_NE(table_text({{"camera_pre", all, us(2'500), {}}})
                .find("malformed frames of camera_pre: 1 wrong form, 1 wrong frame CRC, 3 not of its slot, 1 repeated"),
            std::string::npos);
}

// Frames on the private CANs: camera_objects on line 4, identifier 80; the camera's trigger on line 3, identifier 4.
struct JudgingCan : Judging {
  using Judging::Judging;

  std::array<std::byte, 64> bytes{};

  void can(std::size_t bus, std::uint32_t identifier, MachineTime at, bool fd, std::size_t size) {
    ReceivedFrame received;
    received.form = ReceivedFrame::Form::kCan;
    received.line = bus::ports::line_of_can(bus);
    received.at = at;
    received.can = {identifier, fd, std::span<const std::byte>(bytes).first(size)};
    judge.receive(received);
  }
  void list(std::uint32_t sequence, std::uint32_t fragment, std::uint32_t count, MachineTime at) {
    const schedules::model::PduLayout& layout = cluster.pdu(*cluster.find_pdu("camera_objects"));
    const auto write = [&](const char* name, std::uint32_t value) {
      bus::wire::write_header_raw(layout, std::span(bytes).first(56), bus::wire::header_signal(layout, name), value);
    };
    write("sequence", sequence);
    write("fragment", fragment);
    write("count", count);
    can(2, 80, at, true, 64);
  }
};

TEST_F(JudgingCan, AListMayNotComeTooSoon) {
  judge.begin(kBegin);
  list(0, 0, 5, kBegin);
  list(0, 1, 5, kBegin + us(300));
  list(1, 0, 0, kBegin + us(40'000));
  list(2, 0, 0, kBegin + us(59'600));  // 19.6 ms: the window's 0.5 ms may lie between
  list(3, 0, 0, kBegin + us(75'000));
  EXPECT_EQ(counts().in_window, 4u);
  EXPECT_EQ(counts().early, 1u);
}

TEST_F(JudgingCan, AListMayBeImpossible) {
  judge.begin(kBegin);
  list(0, 0, 26, kBegin);              // more objects than there are
  list(1, 0, 5, kBegin + us(40'000));  // never whole
  list(2, 0, 5, kBegin + us(80'000));
  can(2, 80, kBegin + us(120'000), true, 48);
  can(2, 80, kBegin + us(121'000), false, 8);
  can(2, 64, kBegin + us(122'000), false, 8);  // laser_objects are of another node
  EXPECT_EQ(counts().malformed, (std::array<std::uint64_t, kMalformedKinds>{2, 0, 0, 1, 1, 0, 0}));
  EXPECT_EQ(counts().in_window, 1u);
}

TEST_F(JudgingCan, AListComesOnce) {
  judge.begin(kBegin);
  EXPECT_TRUE(judge.never_received(0).empty());
  ours(0);
  EXPECT_EQ(judge.never_received(0), std::vector<std::string>{"camera_objects"});
  for (int i = 0; i < 500; ++i) list(7, 0, 2, kBegin + us(200 * i));  // whole, as it has one fragment
  EXPECT_EQ(counts().in_window, 2u);
  EXPECT_EQ(counts().malformed[static_cast<std::size_t>(Malformed::kRepeated)], 499u);
  EXPECT_TRUE(judge.never_received(0).empty());
}

// A receiver refuses lists from before, until a third one shows that their sender began anew.
TEST_F(JudgingCan, AListMayNotBeOlder) {
  judge.begin(kBegin);
  for (const std::uint32_t sequence : {100u, 0u, 1u, 2u, 3u}) list(sequence, 0, 0, kBegin + us(40'000) * sequence);
  EXPECT_EQ(counts().malformed[static_cast<std::size_t>(Malformed::kOldList)], 2u);
}

// With no slot of its own: triggers are all that may be missing.
struct JudgingATrigger : JudgingCan {
  JudgingATrigger() : JudgingCan(without_slot()) {}
  static schedules::model::Cluster without_slot() {
    schedules::model::Cluster cluster = paper();
    std::erase_if(cluster.frames, [](const schedules::model::FrameSlot& frame) { return frame.slot == 2; });
    return cluster;
  }
};

TEST_F(JudgingATrigger, OneThatComesAgainMovesNothing) {
  judge.begin(kBegin);
  const auto trigger = [&](int cycle) { can(1, 4, start_of(cycle) + us(900), false, 0); };
  for (const int cycle : {1, 9, 17, 9, 17, 25}) trigger(cycle);
  EXPECT_EQ(counts().malformed[static_cast<std::size_t>(Malformed::kRepeated)], 1u);
  EXPECT_EQ(counts().missing, 0u);
}

TEST_F(JudgingATrigger, ATriggerHasItsInstant) {
  judge.begin(kBegin);
  for (int cycle = 0; cycle < 34; ++cycle) {
    if (cycle == 1) can(1, 4, start_of(cycle) + us(900), false, 0);
    if (cycle == 9) can(1, 4, start_of(cycle) + us(1'500), false, 0);
    if (cycle == 24) can(1, 4, start_of(cycle) + us(4'000), false, 0);  // 1.9 ms before that of cycle 25
    others(cycle);
  }
  EXPECT_EQ(counts().in_window, 1u);
  EXPECT_EQ(counts().late, 1u);
  EXPECT_EQ(counts().early, 1u);
  EXPECT_EQ(counts().missing, 1u);  // cycle 17; 33 is not over
}

TEST_F(Judging, ReceivesNoMoreThanItNeeds) {
  const bus::ports::ReceivedIdentifiers all = judge.identifiers();
  EXPECT_EQ(all.slots, (std::vector<int>{1, 2, 3, 4, 5}));
  EXPECT_EQ(all.can, (std::vector<std::vector<std::uint32_t>>{{}, {4}, {80}}));
}

TEST(ExternalAccounts, SayTheState) {
  Account account{"camera_pre", {}, {}, {}};
  EXPECT_EQ(status_text(account), "waiting");
  account.counts.first = account.counts.last = kBegin;
  account.counts.in_window = 12;
  account.silent = us(1'230'000);
  EXPECT_EQ(status_text(account), "silent for 1.2 s, 12 in window");
  EXPECT_EQ(reported({account})[0].state, "silent for 1.2 s");
  EXPECT_EQ(table_text({}), "");
}

}  // namespace
}  // namespace ttf::cli::launch::external
