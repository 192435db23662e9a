// The medium of a node in real time: the lines that its process is on, and what the node's runner (nodes/runner/) and
// whoever carries the frames owe each other. One small port, several media (SocketCAN, DDS, memory); all pass the laws
// below (tests/laws/live_medium_laws.h).
//
// The wall is lower than flexray_port.h's: here are bytes and instants of the host's clock. Whether a frame came in its
// time, what slot that is and what the node's own clock shows is the runner's.
//   L1  what is sent on a line reaches every other node on that line exactly once, its bytes unchanged, or is counted
//       as lost (counts().lost) by who should have heard it, where the medium can know
//   L2  a node does not hear itself
//   L3  what one node sends on one line arrives in the order in which it was sent
//   L4  LiveArrival::at lies between the begin of send() and LiveArrival::received, which is no later than the return
//       of receive(): all on the receiver's host; so does LiveArrival::left, where it is told
//   L5  the medium keeps no reference to bytes after send() returns; an arrival's bytes are valid until the next
//       receive()
//   L6  send() and receive() never block; after construction nothing allocates on the way, and nothing throws
//   L7  what is none of our signals or frames is counted (counts().foreign, malformed) and never handed over
//   L8  once something is there, descriptor(line) of a line that is watched is readable until receive() has handed it
//       over
//
// Instants of departure. A process sends later than it should, by what its kernel takes to wake it up; and clock
// synchronisation must not take that for the sender's clock. So a sync frame says how late it left: the medium measures
// `late` as it sends, and tells it along with the frame, or, where the frame has no room for it, in a follow-up
// (as AUTOSAR's time synchronisation over CAN does, SYNC and FUP).
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "bus/ports/can_port.h"
#include "bus/ports/flexray_port.h"
#include "core/time.h"

namespace ttf::bus::ports {

// What this host's clock shows that nobody sets: CLOCK_MONOTONIC, the same for all processes of a host.
using HostTime = Instant<struct HostScale>;

// 0 and 1: FlexRay channels A and B; 2 + b: Cluster::can_buses[b].
using Line = std::size_t;
constexpr Line line_of(schedules::model::Channel channel) { return static_cast<Line>(channel); }
constexpr Line line_of_can(std::size_t can_bus) { return 2 + can_bus; }

enum class LiveStatus : std::uint8_t {
  kDone,
  kNoRoom,  // the medium's queue is full: not sent
  kFailed,  // the line is of no use any more; failure() says why
};

// A frame or symbol for one channel.
struct LiveSignal {
  schedules::model::Channel channel{};
  Signal signal = Signal::kFrame;    // kUndecodable: noise
  int slot = 0;                      // of a frame, 1..2047
  Duration duration{};               // of anything else, as long as it is on the wire
  std::span<const std::byte> bytes;  // of a frame: header, payload, trailer; 8..262
  bool tells_late = false;           // a sync frame: receivers are told how late it left
};

struct LiveArrival {
  enum class Kind : std::uint8_t {
    kFlexRay,   // `signal`
    kFollowUp,  // of the sync frame of signal.slot in cycle_counter on signal.channel, which came before: `late`
    kCan,       // `can` on can_bus
  };
  Kind kind = Kind::kFlexRay;
  HostTime at{};                 // when it had arrived
  HostTime received{};           // when the medium had it in its hands here: the kernel's lateness is in it
  std::optional<HostTime> left;  // when its sender gave it to the medium: where that is told, by this host's clock
  LiveSignal signal;
  std::uint8_t cycle_counter = 0;  // of a follow-up
  std::optional<Duration> late;    // how much later than `due` it left: of a follow-up, or of a sync frame that says it
  std::size_t can_bus = 0;
  CanFrame can;
};

// Since the beginning.
struct LiveCounts {
  std::uint64_t sent = 0, received = 0;  // signals and CAN frames
  std::uint64_t not_sent = 0;            // no room
  std::uint64_t lost = 0;                // never heard, and the medium knows of it
  std::uint64_t foreign = 0;             // not ours
  std::uint64_t malformed = 0;           // in our form, but wrong
};

class LiveMedium {
 public:
  virtual ~LiveMedium() = default;

  // `due`: when it should have left, for `late`.
  virtual LiveStatus send(const LiveSignal& signal, HostTime due) = 0;
  virtual LiveStatus send_can(std::size_t can_bus, const CanFrame& frame) = 0;

  // What has arrived, line by line in the order of L3; nothing if nothing is there.
  virtual std::optional<LiveArrival> receive() = 0;

  // For poll(): readable when something is there on this line (L8). Of a line that is not watched it may stay silent.
  // -1: this node is not on that line.
  virtual int descriptor(Line line) const = 0;
  virtual void watch(Line line, bool on) = 0;

  virtual LiveCounts counts() const = 0;
  // One sentence where a line is of no use any more ("vcan0 is down: ..."); empty while all is well.
  virtual const std::string& failure() const = 0;
};

// CLOCK_MONOTONIC, now.
HostTime host_now();

}  // namespace ttf::bus::ports
