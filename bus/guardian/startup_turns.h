// The start-up turns of the central guardian decide, without a schedule, which node may start the cluster. One
// value per channel, no clock, no I/O.
//
// Without a schedule the guardian has little to judge nodes by. But the pattern of a fault-free coldstart node
// is known: a collision avoidance symbol, then one startup frame in every cycle. The other nodes follow a
// faulty node that does likewise, and start the cluster with it or, once they have received each other, without
// it. So any node may lead, but a failed lead is not soon repeated:
//   S1  one node leads at a time: the first to send its collision avoidance symbol or its startup frame. No other node
//       is forwarded until the guardian has a schedule from the leader, or the lead has failed
//   S2  the leader sends one startup frame in a cycle, with the header of its key slot, and no second symbol
//   S3  a lead fails if a cycle passes without a frame, if it gives no schedule within kLeadCycles, or if the
//       guardian's controller drops its schedule before it is synchronised. The failed leader may lead again after
//       kWaitCycles, and follows others meanwhile (bus/guardian/guardian.h G1, G8)
//   S4  a leader that led correctly but stayed alone, with its symbol and the startup frames of cycles 0 to 4, waits
//       only for the silent cycle that follows. Listening nodes would have joined it in cycle 4, and the others shall
//       receive the next symbol. An earlier symbol could keep nodes that gave up the last attempt from ever receiving a
//       cycle 0
//   S5  a wake-up pattern is forwarded on the node's wake-up channel, once in kWaitCycles for each node, and not during
//       a lead
//   S6  all other signals are refused, and all that last too long
// kWaitCycles is more than the other nodes need. They need at most two cycles to give up the schedule they
// followed, two to listen, and four for a new leader to be alone. So one faulty node spoils at most one lead
// in kWaitCycles on each channel. The fault-free coldstart nodes, two at least, have the remaining time.
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

  // Judges a signal while the guardian has no schedule. Changes no state.
  GuardianAnswer judge(const GuardianSignal& signal) const;
  // Notes that the signal is forwarded, with or without a schedule. Returns whether a new lead begins with it,
  // which happens only without one.
  bool forwarded(const GuardianSignal& signal, bool has_schedule);

  // The end of the lead, from the guardian's controller: its schedule dropped again at `at`, or the cluster started.
  void schedule_dropped(Microticks at);
  void synchronised();
  // Allows every node to lead and to wake, as after power-on.
  void reset();

  // Returns the leader until the guardian is synchronised; kNoNode without one.
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
  Microticks cycle_, slack_;  // twice the clocks' drift in a cycle, and an action point offset
  NodeId leader_ = kNoNode;
  Microticks lead_begin_{}, lead_end_{}, next_frame_{};
  // Startup frames, in order, of a lead that began with a symbol: of cycles 0, 1, ...; kOutOfOrder for any other lead.
  int frames_ = 0;
  std::vector<Microticks> may_lead_, may_wake_;  // by NodeId: the earliest instant
};

}  // namespace ttf::bus::guardian
