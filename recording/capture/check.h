// Finds the FlexRay frames of a capture that contradict its schedule, and those that are missing.
//
// The schedule holds in normal operation only; a capture of a start-up is checked from a later instant on
// (CaptureCheckOptions::from_ns).
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
  kMalformed,           // a FlexRay packet with neither a symbol nor a whole frame header
  kHeaderCrc,           // recomputed, or flagged by the capture
  kFrameCrc,            // as flagged: link type 210 carries no trailer
  kCoding,              // flagged: start sequence, coding or frame end
  kStartupWithoutSync,  // a frame with the startup indicator that is no sync frame
  kCycleCounter,        // jumps, or stands still
  kUnownedSlot,         // a frame in a slot without an owner
  kWrongChannel,        // the slot has an owner on the other channel only
  kWrongCycle,          // the slot's owner sends on this channel, but not in this cycle
  kWrongSlot,           // sent outside the slot of its id, by its stamp (wrong_slots.h)
  kTwice,               // a second frame of the same slot, channel and cycle
  kPayloadLength,       // not gPayloadLengthStatic, or not as in the header
  kMissing,             // a frame absent from its owned slot, between the first and the last frame of the
                        // capture
};
inline constexpr std::size_t kContradictions = 13;
// Indexed by value: "header CRC error" etc.
extern const std::array<std::string_view, kContradictions> kContradictionNames;

struct CaptureFinding {
  Contradiction kind{};
  std::uint64_t packet = 0;  // for a missing frame: the packet after which it is missing
  std::string text;          // "slot 6 on A, cycle 12: ..."
};

struct CaptureVerdict {
  std::uint64_t frames = 0;  // FlexRay frames compared with the schedule
  std::uint64_t symbols = 0;
  std::uint64_t other_packets = 0;  // from other link types or channels, or outside the time window
  std::int64_t cycles = 0;          // from the cycle of the first frame to that of the last
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

// The cluster must be consistent (schedules/check/checker.h). Throws InputError if nothing can be compared: the
// time window has no FlexRay frame with a sound header, or is given for a capture without time stamps. Messages
// call the capture `name`.
CaptureVerdict check_capture(const Capture& capture, const std::string& name, const schedules::model::Cluster& cluster,
                             const CaptureCheckOptions& options);

}  // namespace ttf::recording::capture
