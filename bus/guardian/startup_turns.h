// The central guardian without a schedule: whose turn it is to start the cluster. One value per channel, no clock, no
// I/O.
//
// Start-up is the guardian's weak hour: there is no schedule to hold the nodes to. What a fault-free coldstart node
// does, all the same, can be told: a collision avoidance symbol, then one startup frame in every cycle. A faulty one
// that does the like is followed by the others, who start the cluster with it or, once they have heard each other,
// without it. So nobody is kept from leading, but a lead that came to nothing is not soon repeated:
//   S1  one node leads at a time: who first sends its collision avoidance symbol, or its startup frame. Nobody else is
//       forwarded until the guardian has a schedule from it, or the lead has failed
//   S2  the leader sends one startup frame in a cycle, with the header of its key slot, and no second symbol
//   S3  a lead fails if no frame comes for a cycle, if there is no schedule after kLeadCycles of it, or if the
//       guardian's controller drops the schedule it took before it is synchronised. Who led waits for kWaitCycles until
//       it may lead again, and follows others meanwhile (bus/guardian/guardian.h G1, G8)
//   S4  but who led as it should, with its symbol and the startup frames of cycles 0 to 4, and was alone, waits for the
//       silent cycle that follows and no longer: who listened would have joined it in cycle 4, and who did not listen
//       yet shall hear the next symbol. Sooner it could keep those who gave up the last attempt from ever hearing a
//       cycle 0
//   S5  a wake-up pattern is forwarded on the node's wake-up channel, once in kWaitCycles for each node, and not during
//       a lead
//   S6  nothing else, and nothing longer than it may be
// kWaitCycles is more than the others need: at most two cycles to give up what they followed, two to listen, and four
// for a new leader to be alone. So one faulty node spoils at most one lead in kWaitCycles on each channel, and the
// fault-free coldstart nodes, two at least, have the rest.
#pragma once

#include <cstdint>
#include <vector>

#include "bus/guardian/guardian.h"

namespace ttf::bus::guardian {

class StartupTurns {
 public:
  static constexpr int kLeadCycles = 4, kWaitCycles = 12;

  StartupTurns(const schedules::model::Cluster& cluster, schedules::model::Channel channel,
               const schedules::model::NodeParameters& clock);

  // Of a signal at a time when the guardian has no schedule. Nothing changes.
  GuardianAnswer judge(const GuardianSignal& signal) const;
  // It is forwarded, with or without a schedule. True: a new lead begins with it, which only happens without.
  bool forwarded(const GuardianSignal& signal, bool has_schedule);

  // What became of the lead, from the guardian's controller: a schedule dropped again at `at`, or the cluster started.
  void schedule_dropped(Microticks at);
  void synchronised();
  // Everything is open again, as after power-on.
  void reset();

  // Who leads or has led until the guardian was synchronised; else kNoNode.
  NodeId leader() const { return leader_; }

 private:
  static constexpr int kOutOfOrder = -1;
  static constexpr int kFramesOfALead = 5;

  void count_frame(const wire::FrameHeader& header);
  bool leads(Microticks at) const { return leader_ != kNoNode && at < lead_end_; }
  Microticks waits_until(NodeId node, Microticks at) const;
  Microticks cycles(int count) const { return cycle_ * count; }

  const schedules::model::Cluster& cluster_;
  schedules::model::Channel channel_;
  SignalLengths lengths_;
  Microticks cycle_, slack_;  // what a clock may be off in a cycle, twice, and an action point offset
  NodeId leader_ = kNoNode;
  Microticks lead_begin_{}, lead_end_{}, next_frame_{};
  // Of a lead that began with a symbol, of cycles 0, 1, ... ; kOutOfOrder for any other.
  int frames_ = 0;
  std::vector<Microticks> may_lead_, may_wake_;  // by NodeId: from then on
};

}  // namespace ttf::bus::guardian
