// Attributes a check's finding, or a node's harm, to the one fault of the plan that fits it, or to none.
//
//   its own       the slots of the nodes that the fault names (named_by()), these nodes' own reports, and, for a
//                 fault of their reception, all that they receive; from its beginning to its end, and on until they are
//                 back. A fault-free node that it drove out of normal active is its own, too, until that node is back.
//   a channel     every slot in which it acts with signals that are not due there: bursts, frames in others' slots. It
//                 does not make silence.
//   the clocks    if none of the above fits: damage to the cluster's common time affects every slot of every node
//   the cluster   the state and the clock of a fault-free node depend on all others: any fault
// The last two hold while the fault acts, and afterwards as long as a controller tolerates missing sync frames.
// If several faults fit, the cause is the one that acted last, or, if none has acted, the one that began last.
// Nodes stamp in their own microticks, so a fault may seem to come a little after its effect.
#pragma once

#include <cstddef>
#include <deque>
#include <optional>
#include <vector>

#include "core/ids.h"
#include "core/time.h"
#include "evaluation/faults/reach.h"
#include "faults/plan.h"
#include "schedules/model/cluster.h"

namespace ttf::evaluation::faults {

class FaultCauses {
 public:
  using Cause = std::optional<std::size_t>;  // index in the plan

  // `plan` is resolved for the cluster; both must outlive this object.
  FaultCauses(const ttf::faults::FaultPlan& plan, const schedules::model::Cluster& cluster);

  // Report the faults' activities, in the order of time.
  void begins(std::size_t fault, TrueTime at);
  void acts(std::size_t fault, TrueTime at);
  void ends(std::size_t fault, TrueTime at);
  // Report that a node left normal active or lost its supply by `cause`, and that it is normal active again.
  void left(NodeId node, std::size_t cause);
  void is_back(NodeId node);

  bool any_begun(TrueTime by) const;

  // An observation in a slot, or at a star's branch.
  struct Signal {
    NodeId owner = kNoNode;     // sender in the slot; kNoNode: none
    NodeId receiver = kNoNode;  // kNoNode: a guardian
    schedules::model::Channels channels{};
    TrueTime from{}, until{};  // time span
    bool silence = false;      // no signal was there
  };
  Cause of_signal(const Signal& signal) const;
  // Returns the cause of a change of a node's state or clock; kNoNode: of all clocks together.
  Cause of_node(NodeId node, TrueTime at) const;

 private:
  struct Suspect {
    FaultReach reach;
    schedules::model::Channels channels{};  // on which it acts
    std::vector<bool> named, out;           // by NodeId; `out`: left by this fault
    std::optional<TrueTime> began, ended;
    std::deque<TrueTime> acts;  // in the last cycles, and one before
  };
  static bool begun(const Suspect& suspect, TrueTime by);
  static bool acting(const Suspect& suspect, TrueTime since) { return !suspect.ended || *suspect.ended >= since; }
  static bool owns(const Suspect& suspect, NodeId node, TrueTime since);
  static TrueTime last_act(const Suspect& suspect, TrueTime until);
  bool disturbs(const Suspect& suspect, const Signal& signal) const;
  template <class Fits> Cause latest(TrueTime until, Fits fits) const;

  const schedules::model::Cluster& cluster_;
  Duration patience_;              // for a controller without sync frames
  std::vector<Suspect> suspects_;  // by index in the plan
};

}  // namespace ttf::evaluation::faults
