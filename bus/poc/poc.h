// Protocol operation control (POC) of a FlexRay controller: wake-up, start-up and error states as one pure
// function (parameters, state, event) -> next state, actions, reason. It has no clock, no I/O and no
// allocation; time comes as events.
//
// Source: FlexRay protocol specification 2.1, chapters 2 (states, commands), 7 (wake-up, start-up) and 8 (errors
// of clock correction), as implemented by Bosch's E-Ray (TI SPNU563A 26.2.6; register CCSV). Variables keep the
// specification's names; states carry E-Ray's codes (CCSV.POCS). Cycle 0 below follows the leading node's CAS.
//
//   leading coldstart node     coldstart listen -CAS-> collision resolution 0..3 -> consistency check 4, 5
//                              -> active in 6
//   following coldstart node   coldstart listen -> initialise schedule 0, 1 -> integration coldstart check 2, 3
//                              -> coldstart join 4, 5, 6 -> active in 7
//   any other node             integration listen -> initialise schedule 0, 1 -> integration consistency check 2..7
//                              -> active in 8: two consecutive double cycles (4/5, 6/7) with two startup frame pairs
//
// Interpretations where the sources allow two:
//   R1  RUN refills the coldstart attempts, as E-Ray does (CCSV.RCA), and so does configuration; nothing else raises
//       them. Coldstart listen needs more than one left, collision resolution at least one. Entering collision
//       resolution from listening takes one off, and so does entering the gap.
//   R2  Consistency check: without a startup frame in cycle 4 the others were not ready. The gap follows, and a new
//       attempt if one is left. With a frame in cycle 4, but no pair or a clock correction not in order, there is an
//       error, and the node listens again.
//   R3  The gap is one silent cycle; then come a new CAS and a new cycle 0. The silence makes following nodes give up.
//       (S. Cranen's mCRL2 model, FMICS 2012, resumes with the next frame, without a CAS.)
//   R4  A coldstart node follows by the coldstart join path from any listen state, also when coldstart is inhibited or
//       its attempts are exhausted: an inhibited E-Ray may still send startup frames once another node has begun.
//   R5  ALLOW_COLDSTART in integration listen takes a coldstart node with attempts left to coldstart listen. Otherwise
//       the command would have no effect until the next READY and RUN.
//   R6  Integration coldstart check and the first double cycle of integration consistency check pass with startup
//       frames of the node whose schedule was taken, or of two other nodes. Later double cycles need two nodes.
//   R7  Results of clock correction and the host's requests to stop act at the next cycle start, so that they do not
//       cut a dynamic segment. Outside normal operation READY acts at once and HALT is not accepted; FREEZE acts at
//       once in every state. A pending HALT goes before a pending READY, both before clock errors.
//   R8  One correction beyond its limit leads to halt if pAllowHaltDueToClock, else to passive. Missing terms do so
//       after enough consecutive odd cycles without one (vClockCorrectionFailed). That counter stops at 15, as
//       E-Ray's register CCEV says; 26.2.5.1 stops it at gMaxWithoutClockCorrectionFatal, with the same effect on the
//       states.
//   R9  A noise timer that expires starts the cluster even if the channel is not idle at that instant.
//   R10 READY sets coldstart inhibit (register CCSV: "due to CHI command READY"); the return from wake-up does not.
#pragma once

#include <cstdint>

#include "bus/poc/event.h"
#include "bus/poc/reason.h"
#include "core/time.h"
#include "recording/records/enumerations.h"
#include "schedules/model/flexray_parameters.h"

namespace ttf::bus::poc {

// A step passes through wake-up standby, startup prepare, abort startup and startup success; its reason names them.
using recording::records::kAllPocKinds;
using recording::records::PocKind;

// The frames that media access may send.
enum class MacMode : std::uint8_t { kNothing, kStartupFrame, kKeySlot, kAll };

// vPOC!SlotMode; kAllPending takes effect at the next cycle.
enum class SlotMode : std::uint8_t { kKeySlotOnly = 0, kAllPending = 2, kAll = 3 };

// The end of the last wake-up (E-Ray CCSV.WSV).
enum class WakeupStatus : std::uint8_t {
  kUndefined,
  kReceivedHeader,
  kReceivedPattern,
  kCollisionHeader,
  kCollisionPattern,
  kCollisionUnknown,
  kTransmitted
};

// The result of the odd cycle's clock correction, kept until the next cycle start.
enum class ClockVerdict : std::uint8_t { kNone, kInOrder, kTermMissing, kLimitExceeded };

inline constexpr int kMaxClockCorrectionFailed = 15;  // the counter stops here (R8)

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
  int reference = 0;           // frame id of the node whose schedule was taken; 0: no node
  int cycles = 0;              // whole cycles begun in this start-up state
  int good_double_cycles = 0;  // consecutive, in integration consistency check
  ClockVerdict clock = ClockVerdict::kNone;
  int vClockCorrectionFailed = 0;
  int vAllowPassiveToActive = 0;  // consecutive good double cycles since passive
  bool halt_requested = false;    // vPOC!CHIHaltRequest
  bool ready_requested = false;
  bool frozen = false;                            // vPOC!Freeze: halted by FREEZE or a fatal error
  bool coldstart_noise = false;                   // vPOC!ColdstartNoise: the noise timer started the cluster
  PocKind halted_from = PocKind::kDefaultConfig;  // E-Ray CCSV.PSL
  WakeupStatus wakeup_status = WakeupStatus::kUndefined;

  bool operator==(const PocState&) const = default;
};

// Returns whether the node may no longer listen in order to lead (R1); it can still join others.
constexpr bool attempts_exhausted(const PocState& state) { return state.vRemainingColdstartAttempts <= 1; }

// The controller's tasks after a step, in this order.
enum class PocAction : std::uint8_t {
  kStopTimers = 1,          // listen and noise timer
  kDropSchedule = 2,        // cycle clock and clock synchronisation stop
  kRestartListenTimer = 4,  // listen_timeout(); while a channel is busy, kChannelsIdle restarts it anyway
  kStopListenTimer = 8,
  kRestartNoiseTimer = 16,  // noise_timeout()
  kSendWakeupPattern = 32,
  kSendCas = 64,          // and begin cycle 0 of an own schedule after it
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
  PocReason reason{};                        // the step's
  PocReason consequence = PocReason::kNone;  // the listen state that was entered, and why
};

// Returns the state after power-on.
PocState poc_power_on(const PocParameters& parameters);

// Returns the step that an event causes; every pair of state and event has one. The event's data are not checked.
PocStep poc_step(const PocParameters& parameters, const PocState& state, const PocEvent& event);

MacMode mac_mode(const PocState& state);
constexpr bool in_startup(PocKind kind) {
  return kind >= PocKind::kColdstartListen && kind <= PocKind::kInitialiseSchedule;
}
// Returns whether the clock is the cluster's.
constexpr bool in_operation(PocKind kind) { return kind == PocKind::kNormalActive || kind == PocKind::kNormalPassive; }
// Returns whether a schedule is being derived or runs, so that cycle starts can come.
bool has_schedule(PocKind kind);
// Returns whether the listen timer runs only while all channels are idle, and restarts when they become idle.
// In other states activity does not affect it.
bool listen_timer_follows_channels(PocKind kind);
// Returns whether computed corrections are applied: not while only this node's own frame is on the bus.
bool corrects_clock(PocKind kind);

}  // namespace ttf::bus::poc
