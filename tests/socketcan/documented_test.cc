// The examples of docs/socketcan.md, as candump shows them: what the page says by hand is what the code finds.
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "bus/socketcan/flexray_on_can.h"
#include "tests/socketcan/frames.h"

namespace ttf::socketcan {
namespace {

using schedules::Channel;

struct Line {
  Channel channel{};
  canfd_frame can{};
};

// "    vcan0  005  [08]  00 05 ...", indented by four as examples are.
std::vector<Line> candump_lines() {
  std::ifstream page(std::string(TTF_SOURCE_DIR) + "/docs/socketcan.md");
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
  ASSERT_EQ(lines.size(), 8u);
  Reassembly a(Channel::kA), b(Channel::kB);
  struct Said {
    Outcome outcome;
    bus::Signal signal;
    int slot, cycle, words;
    bool sync, null_frame;
    int first_byte;          // of the payload
    std::int64_t ns;
  };
  const std::vector<Said> said{
      {Outcome::kComplete, bus::Signal::kFrame, 1, 0, 8, true, false, 0x00, 0},
      {Outcome::kComplete, bus::Signal::kFrame, 5, 1, 0, false, true, -1, 0},
      {Outcome::kComplete, bus::Signal::kFrame, 5, 1, 0, false, true, -1, 0},
      {Outcome::kComplete, bus::Signal::kFrame, 37, 12, 9, false, false, 0xa0, 0},
      {Outcome::kFragment, bus::Signal::kFrame, 70, 0, 0, false, false, 0, 0},
      {Outcome::kComplete, bus::Signal::kFrame, 70, 63, 30, false, false, 0x01, 0},
      {Outcome::kComplete, bus::Signal::kCas, 0, 0, 0, false, false, 0, 5'700},
      {Outcome::kComplete, bus::Signal::kWakeup, 0, 0, 0, false, false, 0, 1'980'000},
  };
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const Arrival arrival = (lines[i].channel == Channel::kA ? a : b).arrive(lines[i].can);
    ASSERT_EQ(arrival.outcome, said[i].outcome) << i;
    EXPECT_EQ(arrival.slot, said[i].slot) << i;
    if (said[i].outcome == Outcome::kFragment) continue;
    EXPECT_EQ(arrival.signal, said[i].signal) << i;
    EXPECT_EQ(arrival.duration.ns, said[i].ns) << i;
    if (said[i].signal != bus::Signal::kFrame) continue;
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
}

// And sending the same again gives the same lines.
TEST(DocumentedExamples, AreWhatIsSent) {
  const std::vector<Line> lines = candump_lines();
  ASSERT_EQ(lines.size(), 8u);
  const auto same = [](const canfd_frame& one, const canfd_frame& other) {
    return one.can_id == other.can_id && one.flags == other.flags && bytes_of(data_of(one)) == bytes_of(data_of(other));
  };
  Reassembly a(Channel::kA), b(Channel::kB);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const Arrival arrival = (lines[i].channel == Channel::kA ? a : b).arrive(lines[i].can);
    if (arrival.outcome != Outcome::kComplete) continue;
    if (arrival.signal != bus::Signal::kFrame) {
      EXPECT_TRUE(same(symbol_to_can(lines[i].channel, arrival.signal, arrival.duration), lines[i].can)) << i;
      continue;
    }
    const CanFrames again = frame_to_can(arrival.slot, arrival.frame);
    for (std::size_t k = 0; k < again.count; ++k)
      EXPECT_TRUE(same(again.frames[k], lines[i + 1 - again.count + k].can)) << i << " " << k;
  }
}

}  // namespace
}  // namespace ttf::socketcan
