// The processes of one cluster go through virtual time together, one node in each. Only messages pass between
// them: the schedule is the synchroniser.
//
// Every process simulates all media and its own node. It receives the acts of other nodes by their turns, and
// the instants of these turns from their promises. At each turn a node says its acts, until when it will be
// silent, and how soon an arrival may make it speak (nodes/host/promise.h). All processes have all arrivals. So
// each computes every node's next turn (Outlook), and goes on until there without waiting:
//
//   T1  all processes see the same acts and turns in the same order, that of sim/medium/event_queue.h: a node's
//       records are those of a simulation in one process
//   T2  one process can always go on: the node whose turn is first waits for no other
//   T3  a node that is gone (bus/ports/exchange.h) is without supply from the first turn that it did not take, for all
//       others alike
//
// A static schedule makes turns rare: a frame in an own slot, the end of a task. In a start-up, and with frames
// in the dynamic segment, every arrival may be answered, and each has a turn.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <vector>

#include "bus/ports/exchange.h"
#include "core/ids.h"
#include "core/time.h"
#include "nodes/host/promise.h"
#include "schedules/model/cluster.h"
#include "sim/processes/turn.h"

namespace ttf::sim::processes {

// A node as the others see it: the instant of its next turn. All processes with the same arrivals and promises
// come to the same answer, the node's own process included.
class Outlook {
 public:
  using Promise = nodes::host::Promise;

  // Returns the end of its promise: then it must take a turn, if only to go on being silent. Never: it is off.
  Microticks turn() const { return turn_; }

  void begins(Microticks now) { promises({now, Microticks{}, Microticks{}, Microticks{}}); }
  void ends() { promises({kNever<Microticks>}); }
  void promises(const Promise& promise) {
    promise_ = promise;
    turn_ = promise.silent_until;
  }

  void receives_flexray(Microticks now) { moves(now, promise_.after_flexray); }
  void receives_can(Microticks now) { moves(now, promise_.after_can); }
  void receives_trigger(Microticks now) { moves(now, promise_.after_trigger); }

 private:
  void moves(Microticks now, Microticks after) {
    if (after != kNever<Microticks>) turn_ = std::min(turn_, now + after);
  }

  Promise promise_{kNever<Microticks>};
  Microticks turn_ = kNever<Microticks>;
};

class TurnTaking {
 public:
  // `self` is the node of this process.
  TurnTaking(const schedules::model::Cluster& cluster, NodeId self, bus::ports::Exchange& exchange);

  NodeId self() const { return self_; }
  Outlook& outlook(std::size_t node) { return members_[node].outlook; }
  const Outlook& outlook(std::size_t node) const { return members_[node].outlook; }

  // Adds an act of the own node, within its turn.
  void does(const Act& act) { own_.add(act); }
  // Ends the own turn and sends it to the others.
  void speak(Microticks now, const nodes::host::Promise& promise);
  // Returns whether the own node has no act to send.
  bool silent() const { return own_.empty(); }

  // Waits for another node's turn and returns its acts, valid until the next call. Nothing: the node is gone.
  // Throws std::runtime_error if a turn other than the due one comes, or the exchange is lost.
  std::optional<std::span<const Act>> listen(NodeId node, Microticks now);

 private:
  struct Member {
    Outlook outlook;
    std::uint32_t turns = 0;
    std::deque<std::vector<std::byte>> unread;  // turns to come, in their order
    bool gone = false;
  };
  void receive();

  const schedules::model::Cluster& cluster_;
  NodeId self_;
  bus::ports::Exchange& exchange_;
  std::vector<Member> members_;                // by NodeId
  std::vector<std::vector<std::byte>> spare_;  // buffers for turns, to be used again
  std::vector<std::byte> received_;            // the turn that acts_ refers into
  std::vector<Act> acts_;
  TurnWriter own_;
};

}  // namespace ttf::sim::processes
