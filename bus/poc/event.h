// What protocol operation control is told: commands of the host, what the receiver and the wake-up make out, and how
// the communication cycle goes on. Plain data; who tells what when is stated with each event.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace ttf::bus::poc {

enum class PocEventKind : std::uint8_t {
  // The host (E-Ray CHI commands) and the supply.
  kPowerOn,
  kConfig,          // towards configuration; out of halt
  kConfigComplete,  // READY given in config
  kReady,           // READY given anywhere else
  kRun,
  kAllowColdstart,
  kWakeup,
  kAllSlots,    // leave key slot only mode
  kHalt,        // at the end of the cycle
  kFreeze,      // at once
  kFatalError,  // the controller's own: what it found makes going on impossible

  // The receiver, any attached channel unless said otherwise. A controller does not hear itself.
  kChannelActive,  // activity on a channel while all had been idle
  kChannelsIdle,   // all attached channels are idle now (channel idle recognised)
  kCasReceived,
  kWakeupPatternReceived,  // on the channel this node wakes
  kHeaderReceived,         // a frame header with a right CRC; comes before the kStartupFrame of the same frame
  kStartupFrame,           // a valid startup frame (so a sync frame too): frame_id, cycle

  // Timers that the actions of a step start and stop (poc.h).
  kListenTimeout,
  kNoiseTimeout,

  // Wake-up.
  kWakeupSent,       // the whole pattern has left
  kWakeupCollision,  // while sending: somebody else is on the channel

  // The schedule.
  kScheduleNotDerived,  // no second frame in time, or outside pdAcceptedStartupRange
  kClockCorrected,      // in odd cycles, after the static segment: missing, limit_exceeded
  kCycleStarted,        // cycle, ended: what was received in the cycle that ended with this start
};
inline constexpr std::array kAllPocEventKinds = {
    PocEventKind::kPowerOn,
    PocEventKind::kConfig,
    PocEventKind::kConfigComplete,
    PocEventKind::kReady,
    PocEventKind::kRun,
    PocEventKind::kAllowColdstart,
    PocEventKind::kWakeup,
    PocEventKind::kAllSlots,
    PocEventKind::kHalt,
    PocEventKind::kFreeze,
    PocEventKind::kFatalError,
    PocEventKind::kChannelActive,
    PocEventKind::kChannelsIdle,
    PocEventKind::kCasReceived,
    PocEventKind::kWakeupPatternReceived,
    PocEventKind::kHeaderReceived,
    PocEventKind::kStartupFrame,
    PocEventKind::kListenTimeout,
    PocEventKind::kNoiseTimeout,
    PocEventKind::kWakeupSent,
    PocEventKind::kWakeupCollision,
    PocEventKind::kScheduleNotDerived,
    PocEventKind::kClockCorrected,
    PocEventKind::kCycleStarted,
};

// Startup frames of other nodes in the cycle that has ended; a node counts once, whichever channels it was heard on.
struct StartupFramesSeen {
  int frames = 0;                // in the cycle that has ended
  int pairs = 0;                 // in both cycles of the double cycle; meant only when an odd cycle has ended
  bool reference_frame = false;  // whether the node this one follows (PocState::reference) is among the frames
  bool reference_pair = false;   // ... among the pairs
};

struct PocEvent {
  PocEventKind kind{};
  int frame_id = 0;             // kStartupFrame
  int cycle = 0;                // kStartupFrame: counter in its header; kCycleStarted: that of the cycle that starts
  StartupFramesSeen ended{};    // kCycleStarted
  bool missing = false;         // kClockCorrected: the offset or the rate term (E-Ray MOCS, MRCS)
  bool limit_exceeded = false;  // kClockCorrected: either term (E-Ray OCLR, RCLR)

  static constexpr PocEvent startup_frame(int frame_id, int cycle) {
    PocEvent event{PocEventKind::kStartupFrame};
    event.frame_id = frame_id;
    event.cycle = cycle;
    return event;
  }
  static constexpr PocEvent cycle_started(int cycle, const StartupFramesSeen& ended) {
    PocEvent event{PocEventKind::kCycleStarted};
    event.cycle = cycle;
    event.ended = ended;
    return event;
  }
  static constexpr PocEvent clock_corrected(bool missing, bool limit_exceeded) {
    PocEvent event{PocEventKind::kClockCorrected};
    event.missing = missing;
    event.limit_exceeded = limit_exceeded;
    return event;
  }
};

std::string_view to_text(PocEventKind kind);

}  // namespace ttf::bus::poc
