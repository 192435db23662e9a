// A capture held against the schedule it should obey: which of its FlexRay frames contradict it, and which are missing.
//
// The schedule is believed in normal operation: a capture of a start-up, in which not every node sends yet, is checked
// from a later instant on (CaptureCheckOptions::from_ns).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "recording/capture/reader.h"
#include "schedules/model/cluster.h"

namespace ttf::recording::capture {

enum class Contradiction : std::uint8_t {
  kMalformed,           // a FlexRay packet that is neither symbol nor has a whole frame header
  kHeaderCrc,           // recomputed, or flagged by the capture
  kFrameCrc,            // as flagged: link type 210 carries no trailer
  kCoding,              // flagged: start sequence, coding or frame end
  kStartupWithoutSync,  // the startup indicator in a frame that is no sync frame
  kCycleCounter,        // jumps, or stands still
  kUnownedSlot,         // a frame in a slot nobody owns
  kWrongChannel,        // the slot has an owner, on the other channel only
  kWrongCycle,          // ... on this channel, but not in this cycle
  kWrongSlot,           // sent in another slot than the one it bears the id of, as its stamp says (capture_slots.h)
  kTwice,               // a second frame of the same slot, channel and cycle
  kPayloadLength,       // not gPayloadLengthStatic, or not what the header says
  kMissing,             // an owned slot without a frame, between the first and the last frame of the capture
};
inline constexpr std::size_t kContradictions = 13;
// "header CRC error", by value.
extern const std::array<std::string_view, kContradictions> kContradictionNames;

struct CaptureFinding {
  Contradiction kind{};
  std::uint64_t packet = 0;  // of a missing frame: the packet after which it is missing
  std::string text;          // "slot 6 on A, cycle 12: ..."
};

struct CaptureVerdict {
  std::uint64_t frames = 0;  // FlexRay frames held against the schedule
  std::uint64_t symbols = 0;
  std::uint64_t other_packets = 0;  // of other link types or channels, or outside the window
  std::int64_t cycles = 0;          // from the first frame's to the last one's
  std::array<std::uint64_t, kContradictions> counts{};
  std::vector<CaptureFinding> findings;  // by packet; the first kMostFindings

  std::uint64_t contradictions() const;
};
inline constexpr std::size_t kMostFindings = 1000;

struct CaptureCheckOptions {
  schedules::model::Channels channels =
      schedules::model::Channels::kAB;  // a capture of one channel lacks the other's frames
  std::int64_t from_ns = 0;             // since the first FlexRay packet
  std::optional<std::int64_t> to_ns;
};

// The cluster must be consistent (schedules/check/checker.h). Throws InputError if nothing can be said: no FlexRay
// frame with a sound header in the window, or a window of a capture without time stamps. `name` is the capture's, for
// messages.
CaptureVerdict check_capture(const Capture& capture, const std::string& name, const schedules::model::Cluster& cluster,
                             const CaptureCheckOptions& options);

}  // namespace ttf::recording::capture
