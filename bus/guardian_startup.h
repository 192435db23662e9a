// The central guardian without a schedule: whose turn it is to start the cluster. One value per channel, no clock, no I/O.
//
// Start-up is the guardian's weak hour: there is no schedule to hold the nodes to. What a fault-free coldstart node does, all the
// same, can be told: a collision avoidance symbol, then one startup frame in every cycle. A faulty one that does the like is followed
// by the others, who start the cluster with it or, once they have heard each other, without it. So nobody is kept from
// leading, but a lead that came to nothing is not soon repeated:
//   S1  one node leads at a time: who first sends its collision avoidance symbol, or its startup frame. Nobody else is forwarded
//       until the guardian has a schedule from it, or the lead has failed
//   S2  the leader sends one startup frame in a cycle, with the header of its key slot, and no second symbol
//   S3  a lead fails if no frame comes for a cycle, if there is no schedule after kLeadCycles of it, or if the guardian's
//       controller drops the schedule it took before it is synchronised. Who led waits for kWaitCycles until it may lead again,
//       and follows others meanwhile (bus/guardian.h G1, G8)
//   S4  kWaitCycles is more than the others need: at most two cycles to give up what they followed, two to listen, four for
//       a new leader to be alone, one of them for the guardian to have its schedule
//   S5  a wake-up pattern is forwarded on the node's wake-up channel, once in kWaitCycles for each node, and not during a lead
//   S6  nothing else, and nothing longer than it may be
// So one faulty node spoils at most one lead in kWaitCycles on each channel, and the fault-free coldstart nodes, two at least, have the
// rest. A node alone with its attempts loses two of three of them to the wait: nobody is there to hear them, and
// who comes meanwhile hears silence, and leads itself.
#pragma once

#include <cstdint>
#include <vector>

#include "bus/guardian.h"

namespace ttf::bus {

class StartupTurns {
 public:
  static constexpr int kLeadCycles = 4, kWaitCycles = 12;

  StartupTurns(const schedules::Cluster& cluster, schedules::Channel channel, const schedules::NodeParameters& clock);

  // Of a signal at a time when the guardian has no schedule. Nothing changes.
  GuardianAnswer judge(const GuardianSignal& signal) const;
  // It is forwarded. True: a new lead begins with it.
  bool forwarded(const GuardianSignal& signal);

  // What became of the lead, from the guardian's controller: a schedule dropped again at `at`, or the cluster started.
  void schedule_dropped(Microticks at);
  void synchronised();
  // Everything is open again, as after power-on.
  void reset();

  // Who leads or has led until the guardian was synchronised; else kNoNode.
  NodeId leader() const { return leader_; }

 private:
  bool leads(Microticks at) const { return leader_ != kNoNode && at < lead_end_; }
  Microticks waits_until(NodeId node, Microticks at) const;
  Microticks cycles(int count) const { return cycle_ * count; }

  const schedules::Cluster& cluster_;
  schedules::Channel channel_;
  SignalLengths lengths_;
  Microticks cycle_, slack_;             // what a clock may be off in a cycle, twice, and an action point offset
  NodeId leader_ = kNoNode;
  Microticks lead_begin_{}, lead_end_{}, next_frame_{};
  std::vector<Microticks> may_lead_, may_wake_;   // by NodeId: from then on
};

}  // namespace ttf::bus
