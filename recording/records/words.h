// The words of the records' enumerations, each list once. A number without an enumerator, as in a damaged log, has none.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>

#include "recording/records/records.h"

namespace ttf::recording::records {

constexpr std::string_view to_text(CanError error) {
  switch (error) {
    case CanError::kNone: break;
    case CanError::kBit: return "bit";
    case CanError::kStuff: return "stuff";
    case CanError::kForm: return "form";
    case CanError::kCrc: return "CRC";
    case CanError::kAcknowledgement: return "acknowledgement";
  }
  return "";
}

constexpr std::string_view to_text(CanState state) {
  switch (state) {
    case CanState::kActive: return "error active";
    case CanState::kPassive: return "error passive";
    case CanState::kBusOff: return "bus off";
  }
  return "";
}

constexpr std::string_view to_text(PocKind kind) {
  switch (kind) {
    case PocKind::kDefaultConfig: return "default config";
    case PocKind::kConfig: return "config";
    case PocKind::kReady: return "ready";
    case PocKind::kHalt: return "halt";
    case PocKind::kWakeupListen: return "wakeup listen";
    case PocKind::kWakeupSend: return "wakeup send";
    case PocKind::kWakeupDetect: return "wakeup detect";
    case PocKind::kColdstartListen: return "coldstart listen";
    case PocKind::kColdstartCollisionResolution: return "coldstart collision resolution";
    case PocKind::kColdstartConsistencyCheck: return "coldstart consistency check";
    case PocKind::kColdstartGap: return "coldstart gap";
    case PocKind::kColdstartJoin: return "coldstart join";
    case PocKind::kIntegrationListen: return "integration listen";
    case PocKind::kInitialiseSchedule: return "initialise schedule";
    case PocKind::kIntegrationColdstartCheck: return "integration coldstart check";
    case PocKind::kIntegrationConsistencyCheck: return "integration consistency check";
    case PocKind::kNormalActive: return "normal active";
    case PocKind::kNormalPassive: return "normal passive";
  }
  return "";
}

constexpr std::string_view to_text(Symbol symbol) {
  switch (symbol) {
    case Symbol::kCas: return "collision avoidance symbol";
    case Symbol::kWakeup: return "wake-up pattern";
    case Symbol::kMediaTest: return "media access test symbol";
  }
  return "symbol";
}

// Returns how a list was lost at this hop, or "".
constexpr std::string_view loss_text(Hop hop) {
  switch (hop) {
    case Hop::kTorn: return "torn";
    case Hop::kOverwritten: return "overwritten";
    case Hop::kStale: return "fragment came too late";
    case Hop::kDiscarded: return "discarded";
    case Hop::kWritten:
    case Hop::kSent:
    case Hop::kReceived:
    case Hop::kRead: break;
  }
  return "";
}

constexpr std::string_view to_text(TimingFault fault) {
  switch (fault) {
    case TimingFault::kLateWakeUp: return "woken up late";
    case TimingFault::kSlotMissed: return "slot missed";
    case TimingFault::kLateFrame: return "frame came late";
    case TimingFault::kEarlyFrame: return "frame came early";
    case TimingFault::kFramesLost: return "frames lost";
  }
  return "timing problem";
}

// Returns the enumerator with these words.
template <class Enum> constexpr std::optional<Enum> from_text(std::string_view words) {
  for (unsigned number = 0; number <= 0xff && !words.empty(); ++number)
    if (const auto one = static_cast<Enum>(number); to_text(one) == words) return one;
  return std::nullopt;
}

// Joins the words of the bits that are set, from bit 0 on.
inline std::string bits_text(unsigned bits, std::initializer_list<std::string_view> words) {
  std::string text;
  for (const std::string_view word : words) {
    if ((bits & 1u) != 0) text.append(text.empty() ? "" : ", ").append(word);
    bits >>= 1;
  }
  return text;
}
// Returns "" for a sound frame.
inline std::string to_text(ChannelState state) {
  return bits_text(static_cast<unsigned>(state),
                   {"header CRC wrong", "frame CRC wrong", "undecodable", "cut off", "reached no receiver"});
}
// Returns "status 0" and the like if no bit is known.
inline std::string to_text(SlotStatus status) {
  const std::string text = bits_text(status, {"syntax error", "content error", "boundary violation",
                                              "transmission conflict", "no frame", "unexpected frame"});
  return text.empty() ? "status " + std::to_string(unsigned{status}) : text;
}

}  // namespace ttf::recording::records
