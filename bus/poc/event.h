// The events of protocol operation control, as plain data. They are commands of the host, results of the receiver
// and of wake-up, and the progress of the communication cycle. Each event states its sender and its time.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace ttf::bus::poc {

enum class PocEventKind : std::uint8_t {
  // The host (E-Ray CHI commands) and the power supply.
  kPowerOn,
  kConfig,          // towards configuration; also leaves halt
  kConfigComplete,  // READY given in config
  kReady,           // READY given in any other state
  kRun,
  kAllowColdstart,
  kWakeup,
  kAllSlots,    // leave key slot only mode
  kHalt,        // at the end of the cycle
  kFreeze,      // at once
  kFatalError,  // the controller's own: it found an error and cannot go on

  // The receiver, on any attached channel unless stated otherwise. A controller does not receive itself.
  kChannelActive,  // activity on a channel while all were idle
  kChannelsIdle,   // all attached channels are idle (channel idle recognised)
  kCasReceived,
  kWakeupPatternReceived,  // on the channel this node wakes
  kHeaderReceived,         // a frame header with a correct CRC; comes before the kStartupFrame of the same frame
  kStartupFrame,           // a valid startup frame, which is also a sync frame: frame_id, cycle

  // Timers, started and stopped by the actions of a step (poc.h).
  kListenTimeout,
  kNoiseTimeout,

  // Wake-up.
  kWakeupSent,       // the whole pattern has left
  kWakeupCollision,  // while sending: another node is on the channel

  // The schedule.
  kScheduleNotDerived,  // no second frame in time, or the pair is outside pRateCorrectionOut
  kClockCorrected,      // in odd cycles, after the static segment: missing, limit_exceeded
  kCycleStarted,        // cycle; ended: startup frames received in the cycle that ended with this start
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

// Startup frames of other nodes in the cycle that has ended. A node counts once, on whichever channels it was received.
struct StartupFramesSeen {
  int frames = 0;                // in the cycle that has ended
  int pairs = 0;                 // in both cycles of the double cycle; valid only after an odd cycle
  bool reference_frame = false;  // the node that this one follows (PocState::reference) is among the frames
  bool reference_pair = false;   // ... among the pairs
};

struct PocEvent {
  PocEventKind kind{};
  int frame_id = 0;             // kStartupFrame
  int cycle = 0;                // kStartupFrame: counter in its header; kCycleStarted: counter of the new cycle
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
