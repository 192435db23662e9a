// Protocol operation control (POC) of a FlexRay controller: wake-up, start-up, error states, as one pure function
// (parameters, state, event) -> next state, actions, reason. No clock, no I/O, no allocation; time comes as events.
//
// Source: FlexRay protocol specification 2.1, chapters 2 (states, commands), 7 (wake-up, start-up) and 8 (errors of
// clock correction), as implemented by Bosch's E-Ray (TI SPNU563A 26.2.6; register CCSV). The specification's names are
// kept for its variables; the states carry E-Ray's codes (CCSV.POCS). Cycle 0 below follows the leading node's CAS.
//
//   leading coldstart node     coldstart listen -CAS-> collision resolution 0..3 -> consistency check 4, 5
//                              -> active in 6
//   following coldstart node   coldstart listen -> initialise schedule 0, 1 -> integration coldstart check 2, 3
//                              -> coldstart join 4, 5, 6 -> active in 7
//   any other node             integration listen -> initialise schedule 0, 1 -> integration consistency check 2..7
//                              -> active in 8: two consecutive double cycles (4/5, 6/7) with two startup frame pairs
//
// Where the sources allow two readings, the one taken:
//   R1  Coldstart attempts are refilled by RUN, as E-Ray does (CCSV.RCA), and by configuration; nothing else raises
//       them. Coldstart listen needs more than one left, collision resolution more than none. An attempt is taken off
//       when collision resolution is entered from listening, and when the gap is entered.
//   R2  In consistency check: no startup frame in cycle 4 means that the others were not ready, so gap and a new
//       attempt if one is left. A frame in cycle 4, but no pair, or clock correction not in order, means that something
//       is wrong, so back to listening.
//   R3  The gap is one silent cycle; then a new CAS and a new cycle 0. (The silence makes those who followed give up.
//       S. Cranen's mCRL2 model, FMICS 2012, resumes with the next frame, without a CAS.)
//   R4  A coldstart node follows by the coldstart join path from wherever it listened, also when coldstart is inhibited
//       or its attempts are exhausted: an inhibited E-Ray may still send startup frames once another node has begun.
//   R5  ALLOW_COLDSTART in integration listen takes a coldstart node with attempts left to coldstart listen: else the
//       command would stay without effect until the next READY and RUN.
//   R6  Following: startup frames of the node whose schedule was taken, or of two other nodes, carry integration
//       coldstart check and the first double cycle of integration consistency check. After that, two are needed.
//   R7  Results of clock correction and requests of the host to stop act at the next cycle start, so that a dynamic
//       segment under way is not cut. Outside normal operation READY acts at once and HALT is not accepted; FREEZE acts
//       at once everywhere. A pending HALT goes before a pending READY, both before clock errors.
//   R8  One correction beyond its limit takes a node to halt if pAllowHaltDueToClock, else to passive; missing terms do
//       so when enough odd cycles in a row lacked one (vClockCorrectionFailed). That counter stops at 15, as E-Ray's
//       register CCEV says; 26.2.5.1 stops it at gMaxWithoutClockCorrectionFatal, which is the same to the states.
//   R9  A noise timer that expires starts the cluster even if the channel is not idle at that instant.
//   R10 READY sets coldstart inhibit (register CCSV: "due to CHI command READY"); coming back from wake-up does not.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "bus/poc/event.h"
#include "bus/poc/reason.h"
#include "core/time.h"
#include "schedules/model/flexray_parameters.h"

namespace ttf::bus::poc {

// Values: E-Ray CCSV.POCS. Wake-up standby, startup prepare, abort startup and startup success are passed through
// within one step: the reason names them.
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
  kInitialiseSchedule = 0x29,
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

// What the media access may send.
enum class MacMode : std::uint8_t { kNothing, kStartupFrame, kKeySlot, kAll };

// vPOC!SlotMode; pending: from the next cycle on.
enum class SlotMode : std::uint8_t { kKeySlotOnly = 0, kAllPending = 2, kAll = 3 };

// How the last wake-up ended (E-Ray CCSV.WSV).
enum class WakeupStatus : std::uint8_t {
  kUndefined,
  kReceivedHeader,
  kReceivedPattern,
  kCollisionHeader,
  kCollisionPattern,
  kCollisionUnknown,
  kTransmitted
};

// What the odd cycle's clock correction gave, until the next cycle start uses it.
enum class ClockVerdict : std::uint8_t { kNone, kInOrder, kTermMissing, kLimitExceeded };

inline constexpr int kMaxClockCorrectionFailed = 15;  // where the counter stops (R8)

struct PocParameters {
  bool pKeySlotUsedForStartup = false;  // a coldstart node
  bool pKeySlotOnlyEnabled = false;
  int gColdStartAttempts = 8;
  int gMaxWithoutClockCorrectionPassive = 2;  // [double cycles]
  int gMaxWithoutClockCorrectionFatal = 4;    // [double cycles]
  int pAllowPassiveToActive = 0;              // [double cycles], 0: never
  bool pAllowHaltDueToClock = false;
  int pdListenTimeout = 0;  // [uT]
  int gListenNoise = 2;     // factor on pdListenTimeout

  Microticks listen_timeout() const { return {pdListenTimeout}; }
  Microticks noise_timeout() const { return listen_timeout() * gListenNoise; }
};

PocParameters poc_parameters(const schedules::model::GlobalParameters& global,
                             const schedules::model::NodeParameters& node);

struct PocState {
  PocKind kind = PocKind::kDefaultConfig;
  int vRemainingColdstartAttempts = 0;
  bool vColdstartInhibit = true;  // set by READY, cleared by ALLOW_COLDSTART
  SlotMode slot_mode = SlotMode::kAll;
  int reference = 0;           // frame id of the node whose schedule was taken, 0: none
  int cycles = 0;              // whole cycles begun in this state of start-up
  int good_double_cycles = 0;  // consecutive, in integration consistency check
  ClockVerdict clock = ClockVerdict::kNone;
  int vClockCorrectionFailed = 0;
  int vAllowPassiveToActive = 0;  // good double cycles since passive, consecutive
  bool halt_requested = false;    // vPOC!CHIHaltRequest
  bool ready_requested = false;
  bool frozen = false;                            // vPOC!Freeze: halted by FREEZE or a fatal error
  bool coldstart_noise = false;                   // vPOC!ColdstartNoise: the noise timer started the cluster
  PocKind halted_from = PocKind::kDefaultConfig;  // E-Ray CCSV.PSL
  WakeupStatus wakeup_status = WakeupStatus::kUndefined;

  bool operator==(const PocState&) const = default;
};

// It may not listen for others with the intent to lead (R1): what remains is to join them.
constexpr bool attempts_exhausted(const PocState& state) { return state.vRemainingColdstartAttempts <= 1; }

// What the controller has to do, in this order.
enum class PocAction : std::uint8_t {
  kStopTimers = 1,          // listen and noise timer
  kDropSchedule = 2,        // cycle clock and clock synchronisation stop
  kRestartListenTimer = 4,  // listen_timeout(); while a channel is busy: with kChannelsIdle, which restarts it anyway
  kStopListenTimer = 8,
  kRestartNoiseTimer = 16,  // noise_timeout()
  kSendWakeupPattern = 32,
  kSendCas = 64,          // and begin cycle 0 of an own schedule behind it
  kDeriveSchedule = 128,  // from the startup frame just received (PocState::reference)
};

class PocActions {
 public:
  constexpr PocActions() = default;
  constexpr PocActions(PocAction action) : bits_(static_cast<std::uint8_t>(action)) {}
  constexpr bool has(PocAction action) const { return (bits_ & static_cast<std::uint8_t>(action)) != 0; }
  constexpr bool empty() const { return bits_ == 0; }
  constexpr PocActions& operator|=(PocActions other) {
    bits_ |= other.bits_;
    return *this;
  }
  friend constexpr PocActions operator|(PocActions a, PocActions b) { return a |= b; }
  constexpr bool operator==(const PocActions&) const = default;

 private:
  std::uint8_t bits_ = 0;
};

struct PocStep {
  PocState next;
  PocActions actions;
  PocReason reason{};                        // of the step
  PocReason consequence = PocReason::kNone;  // of entering a listen state: which one, and why that one
};

// The state after power-on.
PocState poc_power_on(const PocParameters& parameters);

// Total: every pair of state and event has an answer. What an event carries is trusted (it is the controller's own).
PocStep poc_step(const PocParameters& parameters, const PocState& state, const PocEvent& event);

MacMode mac_mode(const PocState& state);
constexpr bool in_startup(PocKind kind) {
  return kind >= PocKind::kColdstartListen && kind <= PocKind::kInitialiseSchedule;
}
// Whether the clock is the cluster's.
constexpr bool in_operation(PocKind kind) { return kind == PocKind::kNormalActive || kind == PocKind::kNormalPassive; }
// Whether a schedule is derived or runs, that is whether cycle starts can come.
bool has_schedule(PocKind kind);
// Whether the listen timer runs only while all channels are idle, and begins anew whenever they are so again: elsewhere
// it runs on, whatever is heard.
bool listen_timer_follows_channels(PocKind kind);
// Whether computed corrections are applied: not while the own frame is the only one on the bus.
bool corrects_clock(PocKind kind);

std::string_view to_text(PocKind kind);

}  // namespace ttf::bus::poc
