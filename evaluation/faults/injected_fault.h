// The activity of one fault of the plan, from a drive's records.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "core/ids.h"
#include "core/time.h"
#include "recording/records/records.h"

namespace ttf::evaluation::faults {

struct InjectedFault {
  std::uint32_t fault = 0;  // index in the plan
  std::string kind, text;   // the plan's name of the kind; its first act, empty if it never acted
  NodeId node = kNoNode;    // kNoNode: a fault of the medium
  std::optional<TrueTime> begins, ends, first_act;
  std::uint64_t acts = 0;

  // Takes its records, in the order of time. A damaged log may lack some.
  void take(const recording::records::FaultActivity& activity) {
    if (kind.empty()) {
      fault = activity.fault;
      kind = activity.kind;
      node = activity.node;
    }
    if (activity.what == recording::records::FaultAct::kBegins) begins = activity.at;
    if (activity.what == recording::records::FaultAct::kEnds) ends = activity.at;
    if (activity.what != recording::records::FaultAct::kActs || acts++ > 0) return;
    first_act = activity.at;
    text = activity.text;
  }
};

}  // namespace ttf::evaluation::faults
