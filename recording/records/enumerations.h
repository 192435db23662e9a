// Enumerations of the records, each with the words of its enumerators. Numbers are part of the logs' format: append only. A
// number without an enumerator, as in a damaged log, has no words of its own.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>

namespace ttf::recording::records {

// An enumeration whose values are sets of its enumerators, which are bits.
template <class Enum> inline constexpr bool kIsBits = false;
template <class Enum>
concept IsBits = kIsBits<Enum>;
template <IsBits Enum> constexpr Enum operator|(Enum a, Enum b) {
  return static_cast<Enum>(static_cast<unsigned>(a) | static_cast<unsigned>(b));
}
template <IsBits Enum> constexpr Enum& operator|=(Enum& a, Enum b) { return a = a | b; }
// Returns whether the set has one of the bits.
template <IsBits Enum> constexpr bool has(Enum set, Enum bits) {
  return (static_cast<unsigned>(set) & static_cast<unsigned>(bits)) != 0;
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
// Returns the enumerator with these words. Those of a number without an enumerator name none.
template <class Enum> constexpr std::optional<Enum> from_text(std::string_view words) {
  constexpr unsigned kNobodys = 0xff;
  if (words.empty() || words == to_text(static_cast<Enum>(kNobodys))) return std::nullopt;
  for (unsigned number = 0; number < kNobodys; ++number)
    if (const auto one = static_cast<Enum>(number); to_text(one) == words) return one;
  return std::nullopt;
}

// An error that a controller on a private CAN detects. No record has kNone.
enum class CanError : std::uint8_t { kNone = 0, kBit = 1, kStuff = 2, kForm = 3, kCrc = 4, kAcknowledgement = 5 };
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

// The state of error confinement of such a controller.
enum class CanState : std::uint8_t { kActive = 0, kPassive = 1, kBusOff = 2 };
inline constexpr std::size_t kCanStates = 1 + static_cast<std::size_t>(CanState::kBusOff);
constexpr std::string_view to_text(CanState state) {
  switch (state) {
    case CanState::kActive: return "error active";
    case CanState::kPassive: return "error passive";
    case CanState::kBusOff: return "bus off";
  }
  return "";
}

// How a frame was on its channel.
enum class ChannelState : std::uint8_t {
  kSound = 0,
  kHeaderCrc = 1,  // the header CRC fails
  kFrameCrc = 2,   // the frame CRC fails, or the length differs from the header's
  kCoding = 4,     // undecodable for every receiver, wholly or beyond `bytes`
  kCut = 8,        // the frame ends early, after `bytes`; a missing CRC is not wrong
  kNothing = 16    // no receiver got any of it; excludes the other bits
};
template <> inline constexpr bool kIsBits<ChannelState> = true;
// Returns "" for a sound frame.
inline std::string to_text(ChannelState state) {
  return bits_text(static_cast<unsigned>(state),
                   {"header CRC wrong", "frame CRC wrong", "undecodable", "cut off", "reached no receiver"});
}

// The status of a slot on one channel (FlexRay 2.1A vSS): bits. The last one is the host's view of a valid frame.
enum class SlotStatus : std::uint8_t {
  kValidFrame = 0,
  kSyntaxError = 1,
  kContentError = 2,
  kBoundaryViolation = 4,
  kTransmissionConflict = 8,
  kNoFrame = 16,
  // A valid frame that is not in the schedule's slot, cycle and channel. Or its message id, its length or its payload
  // is not that of the slot's list.
  kUnexpectedFrame = 32
};
template <> inline constexpr bool kIsBits<SlotStatus> = true;
// Returns "status 0" and the like if no bit is known.
inline std::string to_text(SlotStatus status) {
  const auto bits = static_cast<unsigned>(status);
  const std::string text = bits_text(bits, {"syntax error", "content error", "boundary violation",
                                            "transmission conflict", "no frame", "unexpected frame"});
  return text.empty() ? "status " + std::to_string(bits) : text;
}

// A step of a list on its way from task to task.
enum class Hop : std::uint8_t {
  kWritten = 1,      // a task's output became visible in a CNI
  kSent = 2,         // its last frame has left
  kReceived = 3,     // complete in the receiver's CNI
  kTorn = 4,         // displaced before all its fragments had arrived: lost
  kRead = 5,         // a task read it at its start for the first time
  kOverwritten = 6,  // a newer list replaced it before any task read it
  kStale = 7,        // a fragment came after a newer list had begun to arrive; not used
  kDiscarded = 8     // a task read it but could not use it: raw data without a strobe have no time
};
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

// The state of a protocol operation control. Numbers are those of E-Ray's CCSV.POCS.
enum class PocKind : std::uint8_t {
  kDefaultConfig = 0x00,
  kReady = 0x01,
  kNormalActive = 0x02,
  kNormalPassive = 0x03,
  kHalt = 0x04,
  kConfig = 0x0F,
  kWakeupListen = 0x11,
  kWakeupSend = 0x12,
  kWakeupDetect = 0x13,
  kColdstartListen = 0x21,
  kColdstartCollisionResolution = 0x22,
  kColdstartConsistencyCheck = 0x23,
  kColdstartGap = 0x24,
  kColdstartJoin = 0x25,
  kIntegrationColdstartCheck = 0x26,
  kIntegrationListen = 0x27,
  kIntegrationConsistencyCheck = 0x28,
  kInitialiseSchedule = 0x29
};
inline constexpr std::array kAllPocKinds = {
    PocKind::kDefaultConfig,
    PocKind::kConfig,
    PocKind::kReady,
    PocKind::kWakeupListen,
    PocKind::kWakeupSend,
    PocKind::kWakeupDetect,
    PocKind::kColdstartListen,
    PocKind::kColdstartCollisionResolution,
    PocKind::kColdstartConsistencyCheck,
    PocKind::kColdstartGap,
    PocKind::kIntegrationListen,
    PocKind::kInitialiseSchedule,
    PocKind::kIntegrationColdstartCheck,
    PocKind::kColdstartJoin,
    PocKind::kIntegrationConsistencyCheck,
    PocKind::kNormalActive,
    PocKind::kNormalPassive,
    PocKind::kHalt,
};
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

enum class Symbol : std::uint8_t { kCas = 1, kWakeup = 2, kMediaTest = 3 };
constexpr std::string_view to_text(Symbol symbol) {
  switch (symbol) {
    case Symbol::kCas: return "collision avoidance symbol";
    case Symbol::kWakeup: return "wake-up pattern";
    case Symbol::kMediaTest: return "media access test symbol";
  }
  return "symbol";
}

// The reason of a central guardian to block a signal. G1.. and S1.. are rules of bus/guardian/guardian.h.
enum class GuardianReason : std::uint8_t {
  kForwarded = 0,
  kOtherForwarded = 1,   // G7
  kUndecodable = 2,      // G5
  kNobodysTime = 3,      // G5: between the segments, in the idle time
  kNotItsSlot = 4,       // G1, G3
  kOutsideWindow = 5,    // G2, G3
  kWrongHeader = 6,      // G1, G3
  kNoSymbolNow = 7,      // G4, G5
  kNoColdstartNode = 8,  // G6
  kNoStartupFrame = 9,   // G6
  kOtherLeads = 10,      // S1, G8
  kTooSoon = 11,         // S2
  kLeadFailed = 12,      // S3
  kNoWakeup = 13,        // S5
};
inline constexpr std::array kAllGuardianReasons = {
    GuardianReason::kForwarded,      GuardianReason::kOtherForwarded, GuardianReason::kUndecodable,
    GuardianReason::kNobodysTime,    GuardianReason::kNotItsSlot,     GuardianReason::kOutsideWindow,
    GuardianReason::kWrongHeader,    GuardianReason::kNoSymbolNow,    GuardianReason::kNoColdstartNode,
    GuardianReason::kNoStartupFrame, GuardianReason::kOtherLeads,     GuardianReason::kTooSoon,
    GuardianReason::kLeadFailed,     GuardianReason::kNoWakeup};
constexpr std::string_view to_text(GuardianReason reason) {
  switch (reason) {
    case GuardianReason::kForwarded: return "forwarded";
    case GuardianReason::kOtherForwarded: return "another signal is being forwarded";
    case GuardianReason::kUndecodable: return "the coupler cannot decode it";
    case GuardianReason::kNobodysTime: return "it lies outside all slots";
    case GuardianReason::kNotItsSlot: return "the branch does not have the slot in this cycle";
    case GuardianReason::kOutsideWindow: return "it begins too far from the action point";
    case GuardianReason::kWrongHeader: return "its header does not fit the slot";
    case GuardianReason::kNoSymbolNow: return "no symbol is due";
    case GuardianReason::kNoColdstartNode: return "during start-up only coldstart nodes may send it";
    case GuardianReason::kNoStartupFrame: return "during start-up only the branch's startup frame may pass";
    case GuardianReason::kOtherLeads: return "another branch leads the start-up";
    case GuardianReason::kTooSoon: return "during start-up the branch may send only once a cycle";
    case GuardianReason::kLeadFailed: return "the branch led a failed start-up and must wait for others";
    case GuardianReason::kNoWakeup: return "no wake-up pattern is due from the branch";
  }
  return "";
}

// The state of a motion planner (nodes/control/gap_planner.h).
enum class PlannerState : std::uint8_t { kDecelerate = 0, kHold = 1, kAccelerate = 2, kStop = 3 };
constexpr std::string_view to_text(PlannerState state) {
  switch (state) {
    case PlannerState::kDecelerate: return "decelerate";
    case PlannerState::kHold: return "hold";
    case PlannerState::kAccelerate: return "accelerate";
    case PlannerState::kStop: return "stop";
  }
  return "";
}

// A missed instant in real time.
enum class TimingFault : std::uint8_t {
  kLateWakeUp = 1,  // an act was due for longer than the arrival window allows
  kSlotMissed = 2,  // too late to send in an own slot
  kLateFrame = 3,   // a frame came after its arrival window and was not used
  kEarlyFrame = 4,  // a frame came before its arrival window and was not used
  kFramesLost = 5   // `count` frames of a slot never came, as the cycle of the next one shows
};
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

}  // namespace ttf::recording::records
