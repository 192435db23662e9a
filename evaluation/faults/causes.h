// Whose doing it was: what a check saw, or a node suffered, goes to the one fault of the plan that it fits, or to none.
//
//   its own       the slots of the nodes that the fault names (named_by()), what these nodes see of themselves, and all
//                 that they receive where the fault is of their hearing; from its beginning to its end, and on until
//                 they are back. A fault-free node that it drove out of normal active is its own until that is back,
//                 too.
//   a channel     every slot in which it acts, where what it sends is not due there: bursts, frames in slots of others.
//                 It does not make silence.
//   the clocks    where nothing of the above fits: what the cluster's common time suffers, every slot of everybody
//                 suffers
//   the cluster   the state and the clock of a fault-free node hang on all others: any fault
// The last two while the fault acts, and after it as long as a controller puts up with missing sync frames.
// Where several fit, it is the one that acted last, or began last where none has acted. Nodes say when in their own
// microticks, so a fault may seem to come a little after what it did.
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

  // `plan`: resolved for the cluster; both must outlive this.
  FaultCauses(const ttf::faults::FaultPlan& plan, const schedules::model::Cluster& cluster);

  // What the faults do, in the order of time.
  void begins(std::size_t fault, TrueTime at);
  void acts(std::size_t fault, TrueTime at);
  void ends(std::size_t fault, TrueTime at);
  // What became of nodes: it left normal active or lost its supply by the doing of `cause`; it is normal active again.
  void left(NodeId node, std::size_t cause);
  void is_back(NodeId node);

  bool any_begun(TrueTime by) const;

  // What was received in a slot, or at a star's branch.
  struct Signal {
    NodeId owner = kNoNode;     // who sends there; kNoNode: nobody
    NodeId receiver = kNoNode;  // who saw it; kNoNode: a guardian
    schedules::model::Channels channels{};
    TrueTime from{}, until{};  // when
    bool silence = false;      // there was nothing
  };
  Cause of_signal(const Signal& signal) const;
  // What became of a node's state or of its clock; kNoNode: of all clocks together.
  Cause of_node(NodeId node, TrueTime at) const;

 private:
  struct Suspect {
    FaultReach reach;
    schedules::model::Channels channels{};  // on which it acts
    std::vector<bool> named, out;           // by NodeId; `out` by its doing
    std::optional<TrueTime> began, ended;
    std::deque<TrueTime> acts;  // of the last cycles, and one before
  };
  static bool begun(const Suspect& suspect, TrueTime by);
  static bool acting(const Suspect& suspect, TrueTime since) { return !suspect.ended || *suspect.ended >= since; }
  static bool owns(const Suspect& suspect, NodeId node, TrueTime since);
  static TrueTime last_act(const Suspect& suspect, TrueTime until);
  bool disturbs(const Suspect& suspect, const Signal& signal) const;
  template <class Fits> Cause latest(TrueTime until, Fits fits) const;

  const schedules::model::Cluster& cluster_;
  Duration patience_;              // of a controller without sync frames
  std::vector<Suspect> suspects_;  // by index in the plan
};

}  // namespace ttf::evaluation::faults
