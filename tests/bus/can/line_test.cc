// Controllers on a line, against levels written by hand from the standard (ISO 11898-1:2015; Bosch CAN Specification
// 2.0, part B).
#include "bus/can/line.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "bus/wire/can_timing.h"
#include "core/random.h"
#include "tests/bus/can/by_hand.h"
#include "tests/bus/can_buses.h"

namespace ttf::bus::can {
namespace {

using Phase = Protocol::Phase;

// A controller's doings, by the bit (from the start of the first frame) at whose end they come.
struct Done {
  std::string what;
  std::size_t member = 0;
  std::size_t bit = 0;
  bool operator==(const Done&) const = default;
};

// Members 0.. on a classic CAN of 1 Mbit/s: a bit is a microsecond.
struct Bench {
  Line line;
  std::string levels;  // as driven, one a bit
  std::vector<Done> done;
  std::vector<bool> everybody, only;
  TrueTime now{};

  explicit Bench(std::size_t members, const schedules::model::CanBus& bus = classic())
      : line(bus, members), everybody(members, true), only(members, false) {
    for (std::size_t m = 0; m < members; ++m) line.power_on(m, true, TrueTime{});
  }
  void start(std::size_t member, const FrameBits& frame) { line.start(member, frame, now); }
  // Passes one bit. Bit `inverted` of the frame is seen inverted by the members in `by`.
  void pass(std::size_t inverted = 9'999, const std::vector<bool>* by = nullptr, bool dominant = false) {
    const std::size_t bit = levels.size();
    levels += line.recessive() && !dominant ? '1' : '0';
    now = line.next();
    Line::Disturbed disturbed;
    disturbed.dominant = dominant;
    disturbed.by = by;
    if (inverted != 9'999) disturbed.bit = inverted;
    const auto& all = line.step(disturbed);
    for (std::size_t m = 0; m < all.size(); ++m) {
      constexpr std::array kErrors{"", "bit", "stuff", "form", "CRC", "acknowledgement"};
      if (all[m].error != CanError::kNone) done.push_back({kErrors[static_cast<std::size_t>(all[m].error)], m, bit});
      if (all[m].accepted && !line[m].transmits()) done.push_back({"accepted", m, bit});
      if (all[m].sent) done.push_back({"sent", m, bit});
    }
  }
  // Passes bits until a member is idle; returns their number.
  std::size_t until_idle(std::size_t member, std::size_t inverted = 9'999, const std::vector<bool>* by = nullptr) {
    const std::size_t before = levels.size();
    do pass(inverted, by);
    while (line[member].phase() != Phase::kIdle && line[member].phase() != Phase::kBusOff);
    return levels.size() - before;
  }
  int transmit_errors(std::size_t member) const { return line[member].confinement().transmit_errors; }
  int receive_errors(std::size_t member) const { return line[member].confinement().receive_errors; }
};

// Identifier 555, one byte 55. Start of frame 0, identifier 1..11, RTR IDE r0 12..14. Length 15..19 with a stuff bit,
// data 20..27. CRC 28..43 with a stuff bit, its delimiter 44. Acknowledgement 45 and 46, end of frame 47..53.
const std::string kFrame = joined("0 10101010101 000 00[1]01 01010101 1111[0]00010010111 1");
FrameBits frame(std::uint32_t identifier = 0x555) {
  const std::vector<std::byte> data{std::byte{0x55}};
  return {false, identifier, data};
}
const std::string kFlag = "000000", kDelimiter = "11111111", kIntermission = "111";

TEST(CanLine, AFrameIsAcknowledgedAcceptedAndSent) {
  Bench bench(3);
  bench.start(0, frame());
  EXPECT_EQ(bench.until_idle(0), 57u);
  EXPECT_EQ(bench.levels, kFrame + joined("0 1 1111111") + kIntermission);
  // The receivers accept at the last but one bit of the end of frame, the transmitter accepts a bit later.
  EXPECT_EQ(bench.done, (std::vector<Done>{{"accepted", 1, 52}, {"accepted", 2, 52}, {"sent", 0, 53}}));
  const std::vector<std::byte> data{std::byte{0x55}};
  EXPECT_EQ(bench.now - TrueTime{}, wire::can_frame_duration(classic(), 0x555, data));
  for (std::size_t m = 0; m < 3; ++m) EXPECT_EQ(bench.line[m].phase(), Phase::kIdle);
}

TEST(CanLine, ALoneTransmitterMissesTheAcknowledgement) {
  Bench bench(1);
  const std::string attempt = kFrame + "1" + kFlag + kDelimiter + kIntermission;
  for (int time = 1; time <= 16; ++time) {
    bench.levels.clear();
    bench.start(0, frame());
    bench.until_idle(0);
    ASSERT_EQ(bench.levels, attempt + (time == 16 ? kDelimiter : "")) << time;  // passive: it waits for eight bits more
    ASSERT_EQ(bench.transmit_errors(0), 8 * time);
  }
  EXPECT_EQ(bench.done.back(), (Done{"acknowledgement", 0, 45}));
  EXPECT_EQ(bench.line[0].confinement().state, CanState::kPassive);
  // From now on its flags are recessive, and it counts no further: it never goes bus off.
  for (int time = 0; time < 50; ++time) {
    bench.levels.clear();
    bench.start(0, frame());
    bench.until_idle(0);
    ASSERT_EQ(bench.levels, kFrame + "1" + "111111" + kDelimiter + kIntermission + "11111111");
    ASSERT_EQ(bench.transmit_errors(0), 128);
  }
}

// Bit 25 of the data, recessive, is seen dominant. The transmitter's flag is 26..31. The receivers have seen dominant
// bits from 24 on; the sixth is 29, so that their flags are 30..35.
TEST(CanLine, ErrorFlagsAreSuperposed) {
  Bench bench(3);
  bench.start(0, frame());
  EXPECT_EQ(bench.until_idle(0, 25), 47u);
  EXPECT_EQ(bench.levels, kFrame.substr(0, 26) + "0000000000" + kDelimiter + kIntermission);
  EXPECT_EQ(bench.done, (std::vector<Done>{{"bit", 0, 25}, {"stuff", 1, 29}, {"stuff", 2, 29}}));
  EXPECT_EQ(bench.transmit_errors(0), 8);
  EXPECT_EQ(bench.receive_errors(1), 1);
  // It sends again at once. A frame sent or received forgives one error.
  bench.levels.clear();
  bench.start(0, frame());
  bench.until_idle(0);
  EXPECT_EQ(bench.levels, kFrame + joined("0 1 1111111") + kIntermission);
  EXPECT_EQ(bench.transmit_errors(0), 7);
  EXPECT_EQ(bench.receive_errors(1), 0);
}

// Bit 24, dominant, is seen recessive: the receivers count from the flag on, to its end. The longest superposition.
TEST(CanLine, TheLongestSuperpositionHasTwelveBits) {
  Bench bench(2);
  bench.start(0, frame());
  bench.until_idle(0, 24);
  EXPECT_EQ(bench.levels, kFrame.substr(0, 25) + kFlag + kFlag + kDelimiter + kIntermission);
}

// Member 1 alone sees a data bit inverted. Its CRC is wrong, so it does not acknowledge. Its flag begins behind the
// acknowledgement. The others see a dominant bit in the end of frame.
TEST(CanLine, OneReceiversErrorIsEverybodys) {
  Bench bench(3);
  bench.only[1] = true;
  bench.start(0, frame());
  bench.until_idle(0, 25, &bench.only);
  EXPECT_EQ(bench.levels, kFrame + joined("0 1") + "0000000" + kDelimiter + kIntermission);
  EXPECT_EQ(bench.done, (std::vector<Done>{{"CRC", 1, 46}, {"bit", 0, 47}, {"form", 2, 47}}));
  EXPECT_EQ(bench.transmit_errors(0), 8);
  EXPECT_EQ(bench.receive_errors(1), 9);  // one, and eight for the dominant bit behind its flag
  EXPECT_EQ(bench.receive_errors(2), 1);
}

// The last bit of the end of frame is seen dominant. The receivers have accepted. The transmitter sends again: they
// get the frame twice.
TEST(CanLine, AnErrorInTheLastBitDuplicatesTheFrame) {
  Bench bench(3);
  bench.start(0, frame());
  bench.until_idle(0, 53);
  EXPECT_EQ(bench.levels, kFrame + joined("0 1 1111111") + kFlag + kDelimiter + kIntermission);
  EXPECT_EQ(bench.done, (std::vector<Done>{{"accepted", 1, 52}, {"accepted", 2, 52}, {"bit", 0, 53}}));
  EXPECT_EQ(bench.receive_errors(1), 0);
  bench.start(0, frame());
  bench.until_idle(0);
  EXPECT_EQ(std::count_if(bench.done.begin(), bench.done.end(), [](const Done& d) { return d.what == "accepted"; }), 4);
}

TEST(CanLine, TheLowerIdentifierWinsAndTheOtherReceivesIt) {
  Bench bench(3);
  bench.start(0, frame(0x555));
  bench.start(1, frame(0x554));
  bench.until_idle(0);
  Bench alone(2);
  alone.start(0, frame(0x554));
  alone.until_idle(0);
  EXPECT_EQ(bench.levels, alone.levels);
  EXPECT_EQ(bench.done.size(), 3u);
  EXPECT_EQ(bench.done.front().what, "accepted");
  EXPECT_EQ(bench.done.front().member, 0u);
  EXPECT_EQ(bench.line[0].decoder().identifier(), 0x554u);
  EXPECT_EQ(bench.transmit_errors(0), 0);
}

// An error-passive transmitter waits for eight bits behind the intermission, and lets others go first.
TEST(CanLine, AnErrorPassiveTransmitterIsSuspended) {
  Bench bench(3);
  for (int time = 0; time < 16; ++time) {
    bench.start(0, frame());
    bench.until_idle(0, 25);
  }
  ASSERT_EQ(bench.transmit_errors(0), 128);
  bench.levels.clear();
  bench.start(0, frame());
  bench.until_idle(1);
  EXPECT_EQ(bench.levels, kFrame + joined("0 1 1111111") + kIntermission);
  EXPECT_EQ(bench.transmit_errors(0), 127);
  EXPECT_EQ(bench.line[0].phase(), Phase::kIdle);  // error active again
  bench.start(0, frame());
  bench.until_idle(0, 25);  // passive once more
  ASSERT_EQ(bench.line[0].confinement().state, CanState::kPassive);
  bench.levels.clear();
  bench.start(0, frame());
  bench.until_idle(1, 25);
  // Its passive flag disturbs no other. The receivers' stuff error destroys the frame.
  EXPECT_EQ(bench.line[0].phase(), Phase::kSuspend);
  bench.start(1, frame(0x7FF));
  bench.until_idle(1);
  EXPECT_EQ(bench.done.back(), (Done{"sent", 1, bench.levels.size() - 4}));
}

TEST(CanLine, ThirtyTwoFailuresAreBusOffAndSilenceEndsIt) {
  Bench bench(2);
  int attempts = 0;
  while (bench.line[0].confinement().state != CanState::kBusOff) {
    bench.start(0, frame());
    bench.until_idle(0, 25);
    ASSERT_LE(++attempts, 40);
  }
  EXPECT_EQ(attempts, 32);
  bench.levels.clear();
  while (bench.line[0].phase() == Phase::kBusOff) bench.pass();
  const std::string silence = bench.levels.substr(bench.levels.rfind('0') + 1);
  EXPECT_EQ(silence.size(), 128u * 11);
  EXPECT_EQ(bench.receive_errors(1), 32);
  EXPECT_EQ(bench.line[0].confinement(), Confinement{});
  bench.start(0, frame());
  bench.until_idle(0);
  EXPECT_EQ(bench.done.back().what, "sent");
}

// Idle receivers take the first bit for a start of frame. The sixth is a stuff error, 6..11 are their flags. Bit 12 is
// the first behind them, 19 the fourteenth dominant one with the flag; then every eighth counts.
TEST(CanLine, AStuckLineMakesReceiversErrorPassiveOnly) {
  Bench bench(2);
  const auto errors_behind = [&](std::size_t bit) {
    while (bench.levels.size() <= bit) bench.pass(9'999, nullptr, true);
    return bench.receive_errors(0);
  };
  EXPECT_EQ(errors_behind(4), 0);
  EXPECT_EQ(errors_behind(5), 1);
  EXPECT_EQ(errors_behind(11), 1);
  EXPECT_EQ(errors_behind(12), 9);
  EXPECT_EQ(errors_behind(18), 9);
  EXPECT_EQ(errors_behind(19), 17);
  EXPECT_EQ(errors_behind(26), 17);
  EXPECT_EQ(errors_behind(27), 25);
  EXPECT_EQ(errors_behind(19 + 8 * 14 - 1), 121);
  EXPECT_EQ(errors_behind(19 + 8 * 14), 129);
  EXPECT_EQ(bench.line[0].confinement().state, CanState::kPassive);
  EXPECT_EQ(errors_behind(10'000), kMostReceiveErrors);
  EXPECT_TRUE(bench.line.endures_dominance());
  // It is free again: the delimiter and the intermission, and they are idle.
  bench.levels.clear();
  bench.until_idle(0);
  EXPECT_EQ(bench.levels, kDelimiter + kIntermission);
}

// From data bit 25 on. Bit 25 is a bit error, 26..31 the flag, and from 39 on every eighth bit costs eight.
TEST(CanLine, AStuckLineTakesATransmitterOffTheBus) {
  Bench bench(2);
  bench.start(0, frame());
  while (bench.levels.size() < 25) bench.pass();
  const auto errors_behind = [&](std::size_t bit) {
    while (bench.levels.size() <= bit) bench.pass(9'999, nullptr, true);
    return bench.transmit_errors(0);
  };
  EXPECT_EQ(errors_behind(25), 8);
  EXPECT_EQ(errors_behind(38), 8);
  EXPECT_EQ(errors_behind(39), 16);
  EXPECT_EQ(errors_behind(47), 24);
  EXPECT_EQ(errors_behind(39 + 8 * 30 - 1), 248);
  EXPECT_EQ(bench.line[0].confinement().state, CanState::kPassive);
  EXPECT_EQ(errors_behind(39 + 8 * 30), 256);
  EXPECT_EQ(bench.line[0].phase(), Phase::kBusOff);
}

// Long dominance passes in eights, as if bit by bit.
TEST(CanLine, EndurancePassesTimeAsItIs) {
  Bench plain(2), quick(2);
  for (Bench* bench : {&plain, &quick})
    for (int bit = 0; bit < 1'000; ++bit) bench->pass(9'999, nullptr, true);
  ASSERT_TRUE(quick.line.endures_dominance());
  quick.line.endure(TrueTime{5'003'000});
  for (Bench* bench : {&plain, &quick}) {
    while (bench->line.next() <= TrueTime{5'003'000}) bench->pass(9'999, nullptr, true);
    bench->levels.clear();
    bench->until_idle(0);
  }
  EXPECT_EQ(plain.now, quick.now);
  EXPECT_EQ(plain.levels, quick.levels);
}

TEST(CanLine, PowerOnWaitsForElevenRecessiveBits) {
  Bench bench(3);
  bench.line.power_off(2);
  bench.start(0, frame());
  for (int bit = 0; bit < 20; ++bit) bench.pass();
  bench.line.power_on(2, false, bench.now);
  bench.until_idle(2);
  // The delimiter of the acknowledgement, the end of frame and the intermission are eleven bits.
  EXPECT_EQ(bench.levels.size(), 57u);
  EXPECT_EQ(bench.done, (std::vector<Done>{{"accepted", 1, 52}, {"sent", 0, 53}}));
}

TEST(CanLine, ABabbleCutOffInTheMiddleIsAStuffError) {
  Bench bench(2);
  bench.start(0, frame());
  while (bench.levels.size() < 26) bench.pass();  // the last was recessive
  bench.line.power_off(0);
  bench.until_idle(1);
  // Bits 25..30 are recessive.
  EXPECT_EQ(bench.done, (std::vector<Done>{{"stuff", 1, 30}}));
  EXPECT_EQ(bench.levels, kFrame.substr(0, 26) + "11111" + kFlag + kDelimiter + kIntermission);
}

// ---- CAN FD

std::vector<std::byte> drawn_data(RandomStream& stream, int length) {
  std::vector<std::byte> data(static_cast<std::size_t>(length));
  for (std::byte& byte : data) byte = static_cast<std::byte>(stream.integer(0, 1) == 0 ? stream.integer(0, 255) : 0);
  return data;
}

TEST(CanLine, FramesTakeTheTimesOfTheirBits) {
  RandomStream stream({14, 0, Purpose::kTest, 1, 0});
  for (int run = 0; run < 500; ++run) {
    schedules::model::CanBus bus = run % 2 == 0 ? fast() : classic();
    if (run % 5 == 0) bus.nominal_bit_rate = 300'000;  // no whole nanoseconds in a bit
    if (run % 5 == 0 && !bus.flexible_data_rate) bus.data_bit_rate = 300'000;
    const auto data =
        drawn_data(stream, kDataLengths[static_cast<std::size_t>(stream.integer(0, bus.flexible_data_rate ? 15 : 8))]);
    const auto identifier = static_cast<std::uint32_t>(stream.integer(0, 2047));
    const wire::CanFrameTimes times = wire::can_frame_times(bus, identifier, data);
    Bench bench(2, bus);
    bench.now = TrueTime{1'234'567};
    const TrueTime start = bench.now;
    bench.start(0, {bus.flexible_data_rate, identifier, data});
    TrueTime accepted{};
    while (bench.line[0].phase() != Phase::kIdle || bench.levels.empty()) {
      bench.pass();
      if (!bench.done.empty() && accepted == TrueTime{}) accepted = bench.now;
    }
    ASSERT_EQ(bench.done.size(), 2u) << run;
    ASSERT_EQ(accepted - start, times.accepted) << run;
    ASSERT_EQ(bench.now - start, times.idle) << run;
    ASSERT_TRUE(std::equal(data.begin(), data.end(), bench.line[1].decoder().data().begin(),
                           bench.line[1].decoder().data().end()));
  }
}

// 17 bits of 1 us up to BRS, then bits of 0.2 us: ESI 17, length 18..21, data from 22 on. Bit 25, recessive, is seen
// dominant and ends at 17 + 9 * 0.2 = 18.8 us; so does the transmitter's data rate. Its flag ends at 24.8 us. The
// receiver has seen its sixth dominant bit (24..29) at 19.6 us; its flag ends at 25.6 us. The transmitter has its
// delimiter and intermission behind it at 35.8 us and begins again, in the last bit of the receiver's intermission.
TEST(CanLine, AnErrorEndsTheDataRateForItsFinder) {
  const std::vector<std::byte> data(8, std::byte{0x55});
  Bench bench(2, fast());
  bench.start(0, {true, 0x555, data});
  std::vector<std::pair<std::string, std::int64_t>> errors;
  while (bench.line[0].phase() != Phase::kIdle || bench.levels.empty()) {
    const std::size_t before = bench.done.size();
    bench.pass(25);
    for (std::size_t d = before; d < bench.done.size(); ++d) errors.emplace_back(bench.done[d].what, bench.now.ns);
  }
  EXPECT_EQ(errors, (std::vector<std::pair<std::string, std::int64_t>>{{"bit", 18'800}, {"stuff", 19'600}}));
  EXPECT_EQ(bench.now, TrueTime{35'800});
  EXPECT_EQ(bench.line[1].phase(), Phase::kIntermission);
  bench.done.clear();
  bench.start(0, {true, 0x555, data});
  while (bench.done.empty()) bench.pass();
  EXPECT_EQ(bench.done.front().what, "accepted");
  EXPECT_EQ(bench.now - TrueTime{35'800}, wire::can_frame_times(fast(), 0x555, data).accepted);
}

}  // namespace
}  // namespace ttf::bus::can
