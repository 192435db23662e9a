// The examples of docs/media/socketcan.md, as candump shows them: the page's hand-made decoding equals the code's.
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "bus/socketcan/flexray_on_can.h"
#include "bus/wire/flexray_crc.h"
#include "tests/bus/socketcan/frames.h"
#include "tests/schedules/exchange/dbc_reader.h"

namespace ttf::bus::socketcan {
namespace {

using schedules::model::Channel;

struct Line {
  Channel channel{};
  canfd_frame can{};
};

// "    vcan0  005  [08]  00 05 ...", indented by four as examples are.
std::vector<Line> candump_lines() {
  std::ifstream page(TTF_SOURCE_DIR "/docs/media/socketcan.md");
  std::vector<Line> lines;
  for (std::string text; std::getline(page, text);) {
    std::istringstream words(text);
    std::string interface, identifier, length, byte;
    if (text.rfind("    vcan", 0) != 0 || !(words >> interface >> identifier >> length)) continue;
    Line line;
    line.channel = interface == "vcan0" ? Channel::kA : Channel::kB;
    line.can.can_id = static_cast<canid_t>(std::stoul(identifier, nullptr, 16));
    line.can.flags = CANFD_BRS | CANFD_FDF;
    while (words >> byte) line.can.data[line.can.len++] = static_cast<std::uint8_t>(std::stoul(byte, nullptr, 16));
    EXPECT_EQ(line.can.len, std::stoul(length.substr(1))) << text;
    lines.push_back(line);
  }
  return lines;
}

TEST(DocumentedExamples, AreWhatTheyAreSaidToBe) {
  const std::vector<Line> lines = candump_lines();
  Reassembly a(Channel::kA), b(Channel::kB);
  struct Said {
    Outcome outcome;
    ports::Signal signal;
    int slot, cycle, words;
    bool sync, null_frame;
    int first_byte;  // the payload's
    std::int64_t ns;
  };
  const std::vector<Said> said{
      {Outcome::kComplete, ports::Signal::kFrame, 1, 0, 8, true, false, 0x00, 0},
      {Outcome::kComplete, ports::Signal::kFrame, 5, 1, 0, false, true, -1, 0},
      {Outcome::kComplete, ports::Signal::kFrame, 5, 1, 0, false, true, -1, 0},
      {Outcome::kComplete, ports::Signal::kFrame, 37, 12, 9, false, false, 0xa0, 0},
      {Outcome::kFragment, ports::Signal::kFrame, 70, 0, 0, false, false, 0, 0},
      {Outcome::kComplete, ports::Signal::kFrame, 70, 63, 30, false, false, 0x01, 0},
      {Outcome::kComplete, ports::Signal::kCas, 0, 0, 0, false, false, 0, 5'700},
      {Outcome::kComplete, ports::Signal::kWakeup, 0, 0, 0, false, false, 0, 1'980'000},
  };
  ASSERT_EQ(lines.size(), said.size() + 1);
  for (std::size_t i = 0; i < said.size(); ++i) {
    const Arrival arrival = (lines[i].channel == Channel::kA ? a : b).arrive(lines[i].can);
    ASSERT_EQ(arrival.outcome, said[i].outcome) << i;
    EXPECT_FALSE(arrival.follow_up) << i;
    EXPECT_EQ(arrival.slot, said[i].slot) << i;
    if (said[i].outcome == Outcome::kFragment) continue;
    EXPECT_EQ(arrival.signal, said[i].signal) << i;
    EXPECT_EQ(arrival.duration.ns, said[i].ns) << i;
    if (said[i].signal != ports::Signal::kFrame) continue;
    const wire::DecodedFrame frame = wire::decode_frame(lines[i].channel, arrival.frame);
    ASSERT_EQ(frame.error, wire::FrameError::kNone) << i;
    EXPECT_EQ(frame.header.frame_id, said[i].slot) << i;
    EXPECT_EQ(frame.header.cycle, said[i].cycle) << i;
    EXPECT_EQ(frame.header.payload_words, said[i].words) << i;
    EXPECT_EQ(frame.header.sync, said[i].sync) << i;
    EXPECT_EQ(frame.header.startup, said[i].sync) << i;
    EXPECT_EQ(frame.header.null_frame, said[i].null_frame) << i;
    EXPECT_EQ(frame.payload.empty() ? -1 : static_cast<int>(frame.payload[0]), said[i].first_byte) << i;
  }
  const Arrival arrival = a.arrive(lines.back().can);
  ASSERT_TRUE(arrival.outcome == Outcome::kComplete && arrival.follow_up);
  EXPECT_EQ(arrival.follow_up->slot, 1);
  EXPECT_EQ(arrival.follow_up->cycle_counter, 0);
  EXPECT_EQ(arrival.follow_up->late.ns, 45'163);
}

// And sending the same again gives the same lines.
TEST(DocumentedExamples, AreWhatIsSent) {
  const std::vector<Line> lines = candump_lines();
  ASSERT_EQ(lines.size(), 9u);
  const auto same = [](const canfd_frame& one, const canfd_frame& other) {
    return one.can_id == other.can_id && one.flags == other.flags && bytes_of(data_of(one)) == bytes_of(data_of(other));
  };
  Reassembly a(Channel::kA), b(Channel::kB);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const Arrival arrival = (lines[i].channel == Channel::kA ? a : b).arrive(lines[i].can);
    if (arrival.outcome != Outcome::kComplete) continue;
    if (arrival.follow_up) {
      EXPECT_TRUE(same(follow_up_to_can(lines[i].channel, *arrival.follow_up), lines[i].can)) << i;
      continue;
    }
    if (arrival.signal != ports::Signal::kFrame) {
      EXPECT_TRUE(same(symbol_to_can(lines[i].channel, arrival.signal, arrival.duration), lines[i].can)) << i;
      continue;
    }
    const CanFrames again = frame_to_can(arrival.slot, arrival.frame);
    for (std::size_t k = 0; k < again.count; ++k)
      EXPECT_TRUE(same(again.frames[k], lines[i + 1 - again.count + k].can)) << i << " " << k;
  }
}

// Third-party tools read identifier 0 by the shipped DBC files.
TEST(ShippedDbc, ReadsSymbolsAndFollowUpsAsTheyAreSent) {
  for (const char* name : {"paper_synchronised", "laser_radar"}) {
    std::ifstream file(TTF_SOURCE_DIR "/schedules/" + std::string(name) + ".dbc");
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    const schedules::exchange::DbcMessage message = schedules::exchange::read_dbc(text).messages.at(0);
    const auto reads = [&](const canfd_frame& can, int kind, const std::string& signal) {
      std::vector<std::byte> data = bytes_of(data_of(can));
      data.resize(static_cast<std::size_t>(message.length));
      EXPECT_EQ(message.signal("kind").raw(data), static_cast<std::uint64_t>(kind)) << signal;
      EXPECT_EQ(message.signal(signal).multiplexed, "m" + std::to_string(kind)) << signal;
      return message.signal(signal).physical(data);
    };
    const auto crc = [](const canfd_frame& can, std::size_t says) {
      return static_cast<double>(wire::frame_crc(Channel::kB, data_of(can).first(says)));
    };
    const std::vector<std::pair<ports::Signal, std::string>> symbols{
        {ports::Signal::kCas, "cas"}, {ports::Signal::kWakeup, "wakeup"}, {ports::Signal::kUndecodable, "noise"}};
    for (std::size_t i = 0; i < symbols.size(); ++i) {
      const canfd_frame can = symbol_to_can(Channel::kB, symbols[i].first, Duration::nanoseconds(3'141'592'653));
      EXPECT_EQ(reads(can, static_cast<int>(i + 1), symbols[i].second + "_duration"), 3'141'592'653.0);
      EXPECT_EQ(reads(can, static_cast<int>(i + 1), symbols[i].second + "_crc"), crc(can, 5));
    }
    const canfd_frame can =
        follow_up_to_can(Channel::kB, {.slot = 1'543, .cycle_counter = 61, .late = Duration::nanoseconds(-1'234'567)});
    EXPECT_EQ(message.length, can.len);
    EXPECT_EQ(reads(can, 4, "slot"), 1'543.0);
    EXPECT_EQ(reads(can, 4, "cycle"), 61.0);
    EXPECT_EQ(reads(can, 4, "late"), -1'234'567.0);
    EXPECT_EQ(reads(can, 4, "follow_up_crc"), crc(can, 8));
  }
}

}  // namespace
}  // namespace ttf::bus::socketcan
