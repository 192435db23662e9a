// How the processes of one cluster go through virtual time together, one node in each, with nothing but messages
// between them: the schedule is the synchroniser.
//
// Every process simulates all media, and its own node. Of the others it knows what they do from what they say in their
// turns, and when those are from what they promised: at each turn a node says what it does that others can notice,
// until when it will be silent, and how soon an arrival may make it speak sooner (nodes/host/promise.h). As everybody
// knows all arrivals, everybody knows when whose next turn is (sim/processes/outlook.h), and goes on until there
// without waiting. So
//
//   T1  all processes see the same acts and turns in the same order, which is that of sim/medium/event_queue.h: what a
//       node records is what it records where one process simulates them all
//   T2  somebody can always go on: the node whose turn is first waits for nobody
//   T3  a node that is gone (bus/ports/exchange.h) is without supply from the turn on that it did not take, for all
//       others alike
//
// A static schedule makes turns rare: a frame in an own slot, the end of a task. Where nodes start up, or have frames
// in the dynamic segment, every arrival may be answered, and there is a turn for each.
#pragma once

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
#include "sim/processes/outlook.h"
#include "sim/processes/turn.h"

namespace ttf::sim::processes {

class TurnTaking {
 public:
  // `self`: the node of this process.
  TurnTaking(const schedules::model::Cluster& cluster, NodeId self, bus::ports::Exchange& exchange);

  NodeId self() const { return self_; }
  Outlook& outlook(std::size_t node) { return members_[node].outlook; }
  const Outlook& outlook(std::size_t node) const { return members_[node].outlook; }

  // What the own node does, within its turn.
  void does(const Act& act) { own_.add(act); }
  // The own turn is over: the others hear of it.
  void speak(Microticks now, const nodes::host::Promise& promise);
  // Nothing has been done that others would have to hear of.
  bool silent() const { return own_.empty(); }

  // The acts of another node's turn, valid until the next call; waits for them. Nothing: the node is gone. Throws
  // std::runtime_error where what came is not the turn that is due, or the exchange is lost.
  std::optional<std::span<const Act>> listen(NodeId node, Microticks now);

 private:
  struct Member {
    Outlook outlook;
    std::uint32_t turns = 0;
    std::deque<std::vector<std::byte>> unheard;  // turns to come, in their order
    bool gone = false;
  };
  void receive();

  const schedules::model::Cluster& cluster_;
  NodeId self_;
  bus::ports::Exchange& exchange_;
  std::vector<Member> members_;                // by NodeId
  std::vector<std::vector<std::byte>> spare_;  // rooms for turns, to be used again
  std::vector<std::byte> heard_;               // the turn that acts_ refers into
  std::vector<Act> acts_;
  TurnWriter own_;
};

}  // namespace ttf::sim::processes
