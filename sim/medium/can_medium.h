// A simulated private CAN in virtual time: arbitration by identifier whenever the bus falls idle, durations
// with the exact stuff bits of the data, and controllers that detect errors and send again (bus/can/).
//
// The fast way: while no controller has counted an error and nothing disturbs the bus, a frame travels as a whole. Its
// receivers accept it at the last but one bit of its end of frame; the bus is idle behind the intermission. The plain
// way goes bit by bit: from an instant at which that does not hold, until all controllers are idle again without an
// error. A supply that comes or goes in the middle of a whole frame has that frame taken up bit by bit from there on.
// tests/sim/medium/can_ways_test.cc holds the two to the same.
//
// Other traffic (CanBus::other_load) is as bad as the checker assumes: the longest frames, at equal distances,
// which take that share of the bus. It begins at a drawn instant, and wins over all frames of the cluster. It
// has no receiver and no records here; it counts as busy time, and its nodes acknowledge the cluster's frames. No
// disturbance touches it. Its frames end with eleven recessive bits like all others: a controller that waits for them,
// to take part or to recover, has them there, and none before (ISO 11898-1:2015, 12.1.4.4; Bosch CAN
// Specification 2.0, part B, chapter 8, rule 12).
//
// A host's frames wait in its controller. It has room for four lists of all its messages and some more frames; the
// frames beyond are dropped. Two frames of one identifier do not collide: the lower node's goes first.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "bus/can/line.h"
#include "bus/ports/can_port.h"
#include "core/ids.h"
#include "core/time.h"
#include "recording/records/records.h"
#include "schedules/model/cluster.h"
#include "sim/medium/can_disturbance.h"
#include "sim/medium/frame_pool.h"
#include "sim/medium/medium_queue.h"

namespace ttf::sim::medium {

// How a controller that is bus off comes back (ISO 11898-1:2015, 12.1.4.4: on the request of its host).
enum class CanRecovery : std::uint8_t {
  kAutomatic,  // it asks at once, and its frames wait
  kByHost,     // its host asks, by restart()
  kNever,
};

class CanMedium {
 public:
  // Returns the most frames that wait in the queues of these nodes or are on their way to them: the room that queue and
  // pool must have for this bus. A queue without room drops frames, so there are never more.
  static std::size_t most_pending(const schedules::model::Cluster& cluster, std::size_t bus,
                                  std::span<const NodeId> nodes);
  // All nodes have their supply and are idle. `sink` gets each frame at its begin, as the wire carries it, and each
  // error frame and change of a controller's state, all in true time; the node has the rest. On the plain way a
  // frame's end is not known at its begin. At its acceptance the sender has an event (kCanSent). Seed and replication
  // draw the instant at which other traffic begins.
  CanMedium(const schedules::model::Cluster& cluster, std::size_t bus, std::span<const NodeId> nodes,
            MediumQueue& queue, FramePool& pool, recording::records::Sink& sink, std::uint64_t seed,
            std::uint32_t replication);
  // `emitted`: a fault sends it in the node's name.
  void send(NodeId sender, TrueTime now, const bus::ports::CanFrame& frame, bool emitted = false);
  // A node that gets its supply waits for eleven recessive bits. It is error active with both counters 0, whatever it
  // was; the sink has the change.
  void power_on(NodeId node, TrueTime now);
  // A node that loses its supply no longer drives the line: a frame of its own breaks off, and the others see recessive
  // bits. Its waiting frames are lost.
  void power_off(NodeId node, TrueTime now);

  // Null: no disturbance.
  void set_disturbance(CanDisturbance* disturbance) { disturbance_ = disturbance; }
  // Always goes the plain way.
  void set_bit_by_bit(bool does) { bit_by_bit_ = does; }
  void set_recovery(CanRecovery recovery) { recovery_ = recovery; }
  // Takes a controller off the bus, and lets it recover: at once, if it does so by itself. A disturbance announces both
  // by touches_can(), so that no frame travels as a whole then.
  void hold_off(NodeId node, TrueTime now);
  void release(NodeId node, TrueTime now);
  // A host starts its controller, which is bus off, anew: its waiting frames are dropped, and it recovers. Returns false
  // if it is not bus off, or is held there.
  bool restart(NodeId node, TrueTime now);
  // Looks at single bits from now on: a disturbance begins.
  void look(TrueTime now);
  // Returns how many frames of the identifier wait at the node now, the one on the bus included.
  int waiting(NodeId node, std::uint32_t identifier, TrueTime now) const;
  // Returns whether the node has its supply and is on this bus.
  bool has(NodeId node) const;

  // Decides the arbitration on an idle bus, and sends the winner.
  void arbitrate(TrueTime now);
  // Ends the bits that are over.
  void end_bits(TrueTime now);
  // Returns how long the bus has carried frames. On the fast way the present one counts to its end. Other traffic
  // counts up to the last instant at which a frame here was queued or begun.
  Duration busy() const { return busy_; }
  std::uint64_t dropped() const { return dropped_; }  // frames without room

 private:
  struct Pending {
    std::size_t sender = 0;  // among the members, which are in the order of their nodes
    std::uint64_t order = 0;
    std::uint32_t identifier = 0;
    std::uint32_t frame = 0;
  };
  struct Member {
    NodeId node{};
    bool on = true;                      // has its supply
    bool held = false;                   // off the bus
    bool recovers = false;               // its host has asked for it
    std::size_t room = 0, waiting = 0;   // frames
    std::optional<std::uint64_t> sends;  // this frame
    TrueTime began{};                    // its frame
    bus::can::CanState state{};          // as reported
  };
  static bool goes_before(const Pending& a, const Pending& b);
  const schedules::model::CanBus& can() const { return cluster_.can_buses[bus_]; }
  std::optional<std::size_t> member_of(NodeId node) const;
  bool touched(TrueTime until) const { return disturbance_ != nullptr && disturbance_->touches_can(bus_, until); }
  bool acknowledged(std::size_t sender) const;
  void report_begin(const Pending& frame, TrueTime start, TrueTime end);
  bool others_may_begin(TrueTime now) const;
  void pass_others(TrueTime now);
  Duration integration() const;
  void arbitrate_at(TrueTime when);
  struct Arrival {
    std::size_t receiver = 0, sender = 0;
    std::uint32_t identifier = 0, frame = 0;
  };
  void schedule_arrival(TrueTime at, const Arrival& arrival, TrueTime start);
  void schedule_sent(TrueTime at, std::size_t sender, TrueTime start);
  bool is_idle(std::size_t member) const { return line_[member].phase() == bus::can::Protocol::Phase::kIdle; }
  bool are_others_idle() const { return line_.size() > members_.size() && is_idle(members_.size()); }
  void forget(std::vector<Pending>::iterator frame);
  void forget_all(std::size_t sender);

  // The fast way.
  struct Whole {
    Pending frame;                    // whose bytes the pool keeps
    TrueTime start{}, end{}, idle{};  // `end` that of the end of frame
  };
  bool send_whole(const Pending& frame, TrueTime now);
  void unfold(TrueTime now);
  // The plain way.
  TrueTime held(TrueTime now) const { return touched(now + Duration{1}) ? disturbance_->holds_can(bus_) : TrueTime{}; }
  void begin_bits(TrueTime now);
  void wake(TrueTime now);
  void leave_bits(TrueTime now);
  void start_frames(TrueTime now);
  void went_by(TrueTime now);
  void brought(std::size_t member, const bus::can::Protocol::Brought& brought, TrueTime now);
  void report_state(std::size_t member, TrueTime now);
  void report_error(std::size_t member, const bus::can::Protocol::Brought& brought, TrueTime now);
  void go_on(TrueTime now);
  void schedule_bits();
  bool is_free() const;
  bool is_clean() const;
  bool is_still() const;
  bool offers() const;
  void stay_off();

  const schedules::model::Cluster& cluster_;
  std::size_t bus_;
  std::vector<Member> members_;
  MediumQueue& queue_;
  FramePool& pool_;
  recording::records::Sink& sink_;
  std::vector<Pending> pending_;
  std::uint64_t next_order_ = 0, dropped_ = 0;
  TrueTime idle_from_{};                      // the bus, for whole frames and other traffic
  std::optional<Whole> whole_;                // the last whole frame
  Duration other_length_{}, other_period_{};  // other traffic's frames; zero without them
  TrueTime next_other_{};                     // the next of them, not on the bus yet
  bool arbitration_due_ = false;
  Duration busy_{};

  CanDisturbance* disturbance_ = nullptr;
  bus::can::Line line_;  // the members, and one more that stands for other traffic's nodes
  CanRecovery recovery_ = CanRecovery::kAutomatic;
  bool bit_by_bit_ = false;
  bool bits_ = false;                    // the plain way at present
  bool resting_ = false;                 // an idle or stuck line, whose bits change nothing
  bool free_ = true;                     // since the last bit
  bool was_disturbed_ = false;           // by then
  TrueTime looked_{};                    // the last bit
  TrueTime bits_due_{};                  // the next event of the plain way
  std::optional<std::size_t> inverted_;  // a bit of the present frame
  std::vector<bool> inverted_for_;       // by member
  bool error_frame_ = false;             // its first flag has been reported
  bus::can::FrameBits frame_bits_;
};

}  // namespace ttf::sim::medium
