// The findings about a single fault, whatever its bus: the checks that noticed it, the harms that it did, and the nodes that it
// put out.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "core/ids.h"
#include "core/time.h"

namespace ttf::evaluation::faults {

// `Check` and `Harm` are enumerations that count from 0.
template <class Check, std::size_t kChecks, class Harm, std::size_t kHarms> struct JudgementOf {
  using Since = std::optional<TrueTime>;        // the first time, if any
  std::array<Since, kChecks> seen_by_others{};  // by check
  std::array<Since, kChecks> seen_by_itself{};  // by the faulty node's own controller
  struct Harmed {
    TrueTime first{};
    NodeId node = kNoNode;    // kNoNode: the harm is not one node's
    NodeId sender = kNoNode;  // the frame's
    int frame_id = 0;         // its slot, or its identifier on a CAN
  };
  std::array<std::optional<Harmed>, kHarms> harms{};  // by harm
  Since passive, halt;                                // any node's, the faulty one included; on a CAN halt is bus off
  // Nodes that lost normal active or their supply, or error active on a CAN: the longest time until one was back, and the
  // number of nodes that did not come back. The time counts from the loss or the end of the fault, whichever was later.
  std::optional<Duration> reintegration;
  int still_out = 0;

  Since detected() const {  // by others
    Since first;
    for (const Since& since : seen_by_others)
      if (since && (!first || *since < *first)) first = since;
    return first;
  }
  // Returns the earliest harm, null without any.
  const Harmed* first_harm() const {
    const Harmed* first = nullptr;
    for (const auto& harm : harms)
      if (harm && (first == nullptr || harm->first < first->first)) first = &*harm;
    return first;
  }
  bool harmed() const { return first_harm() != nullptr; }
};

// Gathers such findings. Nothing counts before the fault's beginning `from`; it ends at `until`.
template <class Check, std::size_t kChecks, class Harm, std::size_t kHarms> class JudgeOf {
 public:
  using Judgement = JudgementOf<Check, kChecks, Harm, kHarms>;
  using Since = typename Judgement::Since;

 protected:
  JudgeOf(TrueTime from, TrueTime until, std::size_t nodes) : from_(from), until_(until), out_since_(nodes) {}

  bool counts(TrueTime at) const { return at >= from_; }
  void set_first(Since& since, TrueTime at) const {
    if (counts(at) && !since) since = at;
  }
  void notice(Check check, bool by_others, bool by_itself, TrueTime at) {
    const auto c = static_cast<std::size_t>(check);
    if (by_others) set_first(judgement_.seen_by_others[c], at);
    if (by_itself) set_first(judgement_.seen_by_itself[c], at);
  }
  void harm(Harm harm, TrueTime at, NodeId node, NodeId sender = kNoNode, int frame_id = 0) {
    auto& harmed = judgement_.harms[static_cast<std::size_t>(harm)];
    if (counts(at) && !harmed) harmed = typename Judgement::Harmed{at, node, sender, frame_id};
  }
  void went_out(NodeId node, TrueTime at) { set_first(out_since_[index_of(node)], at); }
  void came_back(NodeId node, TrueTime at) {
    const Since since = std::exchange(out_since_[index_of(node)], {});
    if (!since) return;
    const Duration out = at - (until_ <= at ? std::max(until_, *since) : *since);
    judgement_.reintegration = std::max(judgement_.reintegration.value_or(Duration{}), out);
  }
  const Judgement& finished() {
    judgement_.still_out =
        static_cast<int>(std::ranges::count_if(out_since_, [](const Since& since) { return since.has_value(); }));
    return judgement_;
  }

  Judgement judgement_;

 private:
  TrueTime from_, until_;
  std::vector<Since> out_since_;  // by NodeId
};

}  // namespace ttf::evaluation::faults
