// Laws of report/timing/windows/painted.h by their names, and windows that come back from their chunks.
#include "report/timing/windows/painted.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "recording/merge/record_place.h"
#include "recording/records/every.h"
#include "report/timing/diagram.h"
#include "report/timing/windows/packed.h"
#include "tests/report/layout.h"
#include "tests/report/synthetic_drive.h"

namespace ttf::report::timing::windows {
namespace {

constexpr Duration kCycle = Duration::milliseconds(5), kLength = Duration::milliseconds(160);

struct Window {
  TrueTime from, to;
  std::string svg;
};

// Passes the records of a span of time on.
class Slice final : public recording::records::Every<Slice> {
 public:
  Slice(recording::records::Sink& sink, TrueTime from, TrueTime to) : sink_(sink), from_(from), to_(to) {}
  template <class Record> void each(const Record& record) {
    placing_->on(record);
    if (at_ >= from_ && at_ < to_) sink_.on(record);
  }

 private:
  recording::records::Sink& sink_;
  TrueTime from_, to_, at_{};
  std::unique_ptr<recording::records::Sink> placing_ =
      recording::merge::placing([this](const recording::merge::RecordPlace& place) { at_ = place.at; });
};

// A fault from 100 ms to 900 ms, and a drive of 1.5 s, about in the order of time.
void drive(recording::records::Sink& sink) {
  namespace records = recording::records;
  for (std::int64_t t = -100; t < 1700; t += 50) {
    Slice slice(sink, at_us(t * 1000), at_us((t + 50) * 1000));
    slice.on(records::FaultActivity{at_us(100'001), 0, records::FaultAct::kBegins, NodeId{1}, "mute", "It is mute."});
    SyntheticDrive{}.drive(slice, 1'500'000);
    slice.on(records::FaultActivity{at_us(900'001), 0, records::FaultAct::kEnds, NodeId{1}, "mute", "It is mute."});
  }
}

std::vector<Window> windows_of(TrueTime anchor, Duration length = kLength, std::size_t most = 1000) {
  std::vector<Window> all;
  PaintedWindows windows(synthetic_names(), kCycle, anchor, length, [&](TrueTime from, TrueTime to, const auto& svg) {
    all.push_back({from, to, svg});
    return all.size() < most;
  });
  drive(windows);
  windows.finish();
  return all;
}

TEST(PaintedWindows, W1EachIsThatOfADiagramByItself) {
  for (const Window& window : windows_of(at_us(750'000))) {
    TimingDiagram alone(synthetic_names(), kCycle, window.from, window.to);
    drive(alone);
    EXPECT_EQ(window.svg, alone.svg(TimingUse::kPage)) << in_ms(window.from) << " ms";
    EXPECT_EQ(count(window.svg, "mute") > 0, window.to > at_us(100'001) && window.from < at_us(900'001))
        << in_ms(window.from) << " ms";
  }
}

TEST(PaintedWindows, W2TheyFollowEachOtherFromTheDrivesBeginToItsEnd) {
  const std::vector<Window> all = windows_of(at_us(750'000));
  ASSERT_GE(all.size(), 9u);
  EXPECT_EQ(all.front().from, TrueTime{});
  EXPECT_EQ(all.front().to, at_us(110'000));
  for (std::size_t w = 1; w < all.size(); ++w) {
    EXPECT_EQ(all[w].from, all[w - 1].to);
    EXPECT_EQ((at_us(750'000) - all[w].from).ns % kLength.ns, 0);
  }
  EXPECT_GE(all.back().to, at_us(1'500'000));
}

TEST(PaintedWindows, W3AnEmptyOneIsLeftOut) {
  std::vector<TrueTime> begins;
  PaintedWindows windows(synthetic_names(), kCycle, {}, kLength, [&](TrueTime from, TrueTime, const auto&) {
    begins.push_back(from);
    return true;
  });
  SyntheticDrive{}.task(windows, 10'000, 10'000, 11'000, 0, 0);
  SyntheticDrive{}.task(windows, 5'000'000, 5'000'000, 5'001'000, 0, 0);
  // A damaged log has a task without end.
  SyntheticDrive{}.task(windows, 5'000'000, 5'000'000, 900'000'000'000, 0, 0);
  windows.finish();
  ASSERT_GE(begins.size(), 2u);
  EXPECT_EQ(begins[0], TrueTime{});
  EXPECT_EQ(begins[1], at_us(4'960'000));
  EXPECT_LT(begins.size(), 20u);
}

TEST(PaintedWindows, PaintsNoMoreThanIsTaken) { EXPECT_EQ(windows_of({}, kLength, 2).size(), 2u); }

std::string bytes_of(const std::string& base64) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  std::uint32_t group = 0;
  int bits = 0;
  for (const char c : base64) {
    if (c == '=') break;
    group = group << 6 | static_cast<std::uint32_t>(digits.find(c));
    if ((bits += 6) >= 8) bytes += static_cast<char>(group >> (bits -= 8) & 255u);
  }
  return bytes;
}

// As report/page/timing_windows.js unpacks a chunk.
std::vector<std::string> unpacked(const std::string& chunk) {
  const std::string bytes = bytes_of(chunk);
  std::string text(32'000'000, '\0');
  uLongf size = text.size();
  EXPECT_EQ(uncompress(reinterpret_cast<Bytef*>(text.data()), &size, reinterpret_cast<const Bytef*>(bytes.data()),
                       bytes.size()),
            Z_OK);
  const auto json = nlohmann::json::parse(text.substr(0, size));
  std::vector<std::size_t> first, at(json["columns"].size(), 1);
  std::vector<std::int64_t> value(at.size(), 0);
  std::size_t marks = 0;
  for (const std::string line : json["lines"]) {
    first.push_back(marks);
    marks += count(line, "\1");
  }
  EXPECT_EQ(marks, at.size());
  std::vector<std::string> all;
  for (const auto& window : json["order"]) {
    std::string& svg = all.emplace_back();
    for (std::size_t i = 0; i < window.size(); ++i) {
      const std::size_t line = window[i];
      if (i > 0) svg += '\n';
      std::size_t column = first[line];
      for (const char c : json["lines"][line].get<std::string>()) {
        if (c != '\1') {
          svg += c;
          continue;
        }
        const auto& numbers = json["columns"][column];
        value[column] += numbers[at[column]++].get<std::int64_t>();
        const auto decimals = numbers[0].get<std::size_t>();
        std::string digits = std::to_string(std::abs(value[column]));
        if (digits.size() <= decimals) digits.insert(0, decimals + 1 - digits.size(), '0');
        if (decimals > 0) {
          digits.insert(digits.size() - decimals, ".");
          while (digits.back() == '0') digits.pop_back();
          if (digits.back() == '.') digits.pop_back();
        }
        svg += (value[column] < 0 ? "-" : "") + digits;
        ++column;
      }
    }
  }
  return all;
}

TEST(PackedWindows, ComeBackByteByByte) {
  std::vector<std::string> svgs;
  for (const Window& window : windows_of(at_us(700'000), Duration::milliseconds(80))) svgs.push_back(window.svg);
  const std::string chunk = packed_chunk(svgs);
  EXPECT_EQ(unpacked(chunk), svgs);
  std::size_t raw = 0;
  for (const std::string& svg : svgs) raw += svg.size();
  EXPECT_LT(chunk.size() * 20, raw);
}

TEST(PackedWindows, NumbersThatAScriptWouldWriteOtherwiseStay) {
  const std::vector<std::string> texts{
      "0 -0 007 1.50 1.5 -1.25 12345678901 0.00001 1234567890.1234 #009e73 a1 M1.2 3L-4 5Z",
      "1 -2 008 1.25 1 -0.5 12345678902 0.00002 12345678.5 #00ff00 a2 M7 3.25L-4.5 0Z",
      "",
      "-",
      "1.",
      ".5",
      "1.2.3"};
  std::string joined;
  for (const std::string& text : texts) joined += text + "\n";
  EXPECT_EQ(unpacked(packed_chunk({joined, "x", joined})), (std::vector<std::string>{joined, "x", joined}));
}

TEST(PackedWindows, AreTakenUntilTheirBytesAreReached) {
  WindowPacker packer(3'000);
  std::size_t taken = 0;
  for (const Window& window : windows_of({})) {
    ++taken;
    if (!packer.add(window.from, window.to, window.svg)) break;
  }
  EXPECT_EQ(taken, 6u);  // a chunk
  EXPECT_EQ(packer.full_at(), at_us(960'000));
  const auto json = packer.finish();
  EXPECT_EQ(json["windows"].size(), 6u);
  EXPECT_EQ(json["windows"][1], (nlohmann::ordered_json{160.0, 320.0}));
  EXPECT_EQ(json["chunks"].size(), 1u);
  EXPECT_TRUE(WindowPacker(3'000).finish().is_null());
}

}  // namespace
}  // namespace ttf::report::timing::windows
