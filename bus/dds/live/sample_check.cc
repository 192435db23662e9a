#include "bus/dds/live/sample_check.h"

#include <algorithm>
#include <array>
#include <cstdint>

#include "bus/dds/live/line.h"
#include "bus/wire/flexray_frame.h"

namespace ttf::bus::dds::live {
namespace {

// Larger instants and durations (a century, eleven days) come from no clock.
constexpr std::int64_t kLatest = 4'000'000'000'000'000'000, kLongest = 1'000'000'000'000'000;

bool is_can_length(std::size_t size, bool fast) {
  static constexpr std::array<std::size_t, 7> kFast{12, 16, 20, 24, 32, 48, 64};
  return size <= 8 || (fast && std::find(kFast.begin(), kFast.end(), size) != kFast.end());
}

}  // namespace

bool well_formed(const ttf_LiveSample& sample, ports::Line line) {
  const std::size_t size = sample.bytes._length;
  const bool is_frame = line < ports::line_of_can(0) && sample.kind == static_cast<int>(ports::Signal::kFrame);
  if (sample.tells_late > 1 || (sample.tells_late == 1 && !is_frame)) return false;
  if (line >= ports::line_of_can(0))
    return (sample.kind == kClassicCan || sample.kind == kFastCan) && sample.identifier <= 0x7FF &&
           is_can_length(size, sample.kind == kFastCan);
  if (is_frame)
    return sample.slot >= 1 && sample.slot <= 2047 && size >= wire::kHeaderBytes + wire::kTrailerBytes &&
           size <= wire::kMaxFrameBytes;
  return sample.kind <= static_cast<int>(ports::Signal::kUndecodable) && size == 0 && sample.duration > 0;
}

bool of_a_clock(const ttf_LiveSample& sample) {
  return sample.sent >= 0 && sample.sent <= kLatest && sample.late >= -kLongest && sample.late <= kLongest &&
         sample.duration >= 0 && sample.duration <= kLongest;
}

}  // namespace ttf::bus::dds::live
