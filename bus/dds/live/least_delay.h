// The least delay of samples from another machine, by that machine's stamp and this machine's clock. It has
// the offset of the two clocks and the network's least delay in one. Pure.
//
// A frame leaves at s by the other machine's clock and is in hand at r by this one's. Its delay is d = r - s.
// The late wake-up of the reader only adds to d, so the least delay among recent frames has the least of it.
// The frame arrived at s plus that minimum, whatever happened to it then.
//
//   least(r) = min over the frames of the last second of  d_i + drift * (r - r_i),  never more than the frame's own d
//   drift    = (d_new - d_old) / (r_new - r_old), the frames of least delay among those of the newest and of the oldest
//              five seconds of the last fifteen. 0 without such frames, if no two clocks drift apart so fast, or if
//              the frame of least delay of the five seconds between them is off that line: then a clock was set, or
//              the frames are too few for good minima
//
// Assumption: among the frames of a second some are hardly delayed. Errors:
//   * clocks that drift apart by p: p * 31 ms, the width of a bin (3 us at 100 ppm), once the drift is known; until
//     then p * 1 s, too early and only while the delay grows: 100 us at 100 ppm, 1 us between machines with NTP;
//   * the other's clock set ahead: no error, the next frame is the least delayed. Set back by S: S too early for a
//     second. Either way the drift is 0 for fifteen seconds; an S too small to notice, some 100 us, is partly taken
//     for drift, with an error below S;
//   * the first frames: the delay of the least delayed so far. The first arrives when it is in hand.
// Method: V. Paxson, "On Calibrating Measurements of Packet Transit Times", 1998 (minima of intervals); S. Moon, P.
// Skelly, D. Towsley, "Estimation and Removal of Clock Skew from Network Delay Measurements", 1999 (from below).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "bus/ports/live_medium.h"
#include "core/time.h"

namespace ttf::bus::dds::live {

class LeastDelay {
 public:
  static constexpr Duration kWindow = Duration::milliseconds(1000);
  // Largest drift [ns/s]: either clock 100 ppm off, and the error of the minima.
  static constexpr std::int64_t kFastest = 300'000;
  static constexpr Duration kBend = Duration::microseconds(50);  // largest distance from the line

  // Returns the least delay with a frame that was in hand at `received` and, by its sender's stamp, took
  // `delay`. `received` does not decrease. Delays may have either sign, and differ by less than 2^63 ns.
  Duration least(ports::MachineTime received, Duration delay);

 private:
  struct Frame {
    ports::MachineTime received{};
    Duration delay{};
  };
  // The least delayed frame in each of the last kBins intervals.
  template <std::size_t kBins> class Minima {
   public:
    explicit Minima(Duration width) : width_(width) {}
    void add(const Frame& frame);
    // Returns the least of the intervals `from` up to before `to`, counted back from the last; null without frames.
    const Frame* among(std::size_t from, std::size_t to) const;

   private:
    static constexpr std::int64_t kNone = std::numeric_limits<std::int64_t>::min();
    struct Bin {
      std::int64_t number = kNone;
      Frame least;
    };
    const Bin* bin(std::size_t back) const;
    Duration width_;
    std::int64_t last_ = kNone;
    std::array<Bin, kBins> bins_{};
  };
  static constexpr std::size_t kShort = 32, kThird = 5;

  std::int64_t drift() const;  // [ns/s]

  Minima<kShort> short_{Duration::nanoseconds(kWindow.ns / static_cast<std::int64_t>(kShort))};
  Minima<3 * kThird> long_{Duration::milliseconds(1000)};
};

}  // namespace ttf::bus::dds::live
