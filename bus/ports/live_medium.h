// The live medium is a node's medium in real time: the contract between the node's runner (nodes/runner/) and
// the carrier of its lines. Every medium behind it (SocketCAN, DDS, memory) passes the laws below
// (tests/laws/live_medium_laws.h).
//
// The boundary is lower than that of flexray_port.h: the medium has bytes and instants of the machine's clock. The
// runner decides slots, arrival windows and the node's own time.
//   L1  a signal or CAN frame on a line reaches every other node on that line exactly once, bytes unchanged; otherwise
//       the node that missed it counts it as lost (counts().lost) where the medium can detect it
//   L2  a node does not receive itself
//   L3  what one node sends on one line arrives in the order in which it was sent
//   L4  LiveArrival::at, and LiveArrival::left if given, lie between the beginning of send() and LiveArrival::received,
//       which is no later than the return of receive(): all by the receiver's machine
//   L5  the medium keeps no reference to bytes after send() returns; an arrival's bytes are valid until the next
//       receive()
//   L6  send() and receive() never block; after construction nothing allocates on the way, and nothing throws
//   L7  data that are not our signals or frames are counted (counts().foreign, malformed) and never handed over
//   L8  descriptor(line) of a watched line is readable from the first arrival until receive() has handed over the last
//
// A process sends late by the time that its kernel needs to wake it up. Clock synchronisation must not take
// that lateness for the sender's clock. So the medium measures the lateness of a sync frame as it sends it. It
// states it in the frame or, if the frame has no room, in a follow-up (as AUTOSAR's time synchronisation over
// CAN does, SYNC and FUP).
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "bus/ports/can_port.h"
#include "bus/ports/flexray_port.h"
#include "core/time.h"
#include "recording/records/enumerations.h"

namespace ttf::bus::ports {

// The time of this machine's CLOCK_MONOTONIC, which cannot be set and is the same for all its processes.
using MachineTime = Instant<struct MachineScale>;

// 0 and 1: FlexRay channels A and B; 2 + b: Cluster::can_buses[b].
using Line = std::size_t;
constexpr Line line_of(schedules::model::Channel channel) { return static_cast<Line>(channel); }
constexpr Line line_of_can(std::size_t can_bus) { return 2 + can_bus; }

enum class LiveStatus : std::uint8_t {
  kDone,
  kNoRoom,  // the medium's queue is full: not sent
  kFailed,  // the line has failed for good; failure() says why
};

// A frame or symbol for one channel.
struct LiveSignal {
  schedules::model::Channel channel{};
  Signal signal = Signal::kFrame;    // kUndecodable: noise
  int slot = 0;                      // a frame's: 1..2047
  Duration duration{};               // for all but frames: the time on the wire
  std::span<const std::byte> bytes;  // a frame's header, payload, trailer; 8..262
  bool states_late = false;          // a sync frame: states to receivers how late it left
};

// A report of a CAN's controller about an error, or about its state of error confinement.
struct CanReport {
  recording::records::CanError error{};  // none: it is about the state only
  bool as_transmitter = false;
  std::optional<recording::records::CanState> state;      // it has this one
  std::uint16_t transmit_errors = 0, receive_errors = 0;  // 0 where the carrier does not state it
};

struct LiveArrival {
  enum class Kind : std::uint8_t {
    kFlexRay,   // `signal`
    kFollowUp,  // `late` of the sync frame that came before: of signal.slot in cycle_counter on signal.channel
    kCan,       // `can` on can_bus
    kCanReport  // `report` of the node's own controller on can_bus; no frame of another node
  };
  Kind kind = Kind::kFlexRay;
  MachineTime at{};                 // when the frame had arrived
  MachineTime received{};           // when the medium got it on this machine: the kernel's lateness included
  std::optional<MachineTime> left;  // when its sender gave it to the medium, if stated; by this machine's clock
  LiveSignal signal;
  std::uint8_t cycle_counter = 0;  // for a follow-up
  std::optional<Duration> late;    // lateness of the departure against `due`: of a follow-up, or of a sync frame that
                                   // states it
  std::size_t can_bus = 0;
  CanFrame can;
  CanReport report;
};

// Counted since construction.
struct LiveCounts {
  std::uint64_t sent = 0, received = 0;  // signals and CAN frames
  std::uint64_t not_sent = 0;            // no room
  std::uint64_t lost = 0;                // known to the medium, but never received
  std::uint64_t foreign = 0;             // from other senders than ours
  std::uint64_t malformed = 0;           // in our form, but wrong
};

class LiveMedium {
 public:
  virtual ~LiveMedium() = default;

  // Sends at once; `due` is the instant at which the signal should have left, from which `late` follows.
  virtual LiveStatus send(const LiveSignal& signal, MachineTime due) = 0;
  virtual LiveStatus send_can(std::size_t can_bus, const CanFrame& frame) = 0;

  // Returns the next arrival, line by line in the order of L3; no value if there is none.
  virtual std::optional<LiveArrival> receive() = 0;

  // Returns a descriptor for poll(), readable when an arrival waits on this line (L8). It may stay silent if
  // the line is not watched. -1: this node is not on that line.
  virtual int descriptor(Line line) const = 0;
  virtual void watch(Line line, bool on) = 0;

  virtual LiveCounts counts() const = 0;
  // Returns one sentence about a failed line ("vcan0 is down: ..."); empty without a failure.
  virtual const std::string& failure() const = 0;
};

// Returns the present time of CLOCK_MONOTONIC.
MachineTime host_now();

}  // namespace ttf::bus::ports
