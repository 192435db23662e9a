#include "bus/dds/live/least_delay.h"

#include <algorithm>
#include <cstdlib>

namespace ttf::bus::dds::live {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;

}  // namespace

template <std::size_t kBins> void LeastDelay::Minima<kBins>::add(const Frame& frame) {
  last_ = std::max(last_, frame.received.ns / width_.ns);
  Bin& now = bins_[static_cast<std::size_t>(last_) % kBins];
  if (now.number != last_ || frame.delay < now.least.delay) now = {last_, frame};
}

template <std::size_t kBins>
const typename LeastDelay::Minima<kBins>::Bin* LeastDelay::Minima<kBins>::bin(std::size_t back) const {
  if (last_ < static_cast<std::int64_t>(back)) return nullptr;  // also before the first frame
  const std::int64_t number = last_ - static_cast<std::int64_t>(back);
  const Bin& found = bins_[static_cast<std::size_t>(number) % kBins];
  return found.number == number ? &found : nullptr;
}

template <std::size_t kBins>
const LeastDelay::Frame* LeastDelay::Minima<kBins>::among(std::size_t from, std::size_t to) const {
  const Frame* least = nullptr;
  for (std::size_t back = from; back < to; ++back)
    if (const Bin* const one = bin(back); one != nullptr && (least == nullptr || one->least.delay < least->delay))
      least = &one->least;
  return least;
}

Duration LeastDelay::least(ports::MachineTime received, Duration delay) {
  short_.add({received, delay});
  long_.add({received, delay});
  const std::int64_t slope = drift();
  Duration least = delay;
  for (std::size_t back = 0; back < kShort; ++back)
    if (const Frame* const frame = short_.among(back, back + 1)) {
      const Duration since = received - frame->received;
      least = std::min(least, frame->delay + Duration::nanoseconds(slope * since.ns / kSecond));
    }
  return least;
}

// After a clock was set delays may differ by any amount, so they are compared before they are multiplied.
std::int64_t LeastDelay::drift() const {
  const Frame* const newer = long_.among(0, kThird);
  const Frame* const middle = long_.among(kThird, 2 * kThird);
  const Frame* const older = long_.among(2 * kThird, 3 * kThird);
  if (newer == nullptr || middle == nullptr || older == nullptr) return 0;
  const Duration grown = newer->delay - older->delay, passed = newer->received - older->received;
  const std::int64_t most = passed.ns / kSecond * kFastest;
  if (grown.ns < -most || grown.ns > most) return 0;
  const std::int64_t slope = grown.ns * (kSecond / 1000) / (passed.ns / 1000);
  const Duration line = older->delay + Duration::nanoseconds(slope * (middle->received - older->received).ns / kSecond);
  return std::abs((middle->delay - line).ns) <= kBend.ns ? slope : 0;
}

}  // namespace ttf::bus::dds::live
