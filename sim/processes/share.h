// Filters records when each process simulates one node: each keeps its own node's records, the first also those
// of no node. All processes see the records that belong to no executive: signals' ways on the channels,
// guardians' interventions, faults. Together they keep each of these once.
#pragma once

#include <type_traits>

#include "core/ids.h"
#include "recording/records/every.h"

namespace ttf::sim::processes {

class Share final : public recording::records::Every<Share> {
 public:
  Share(NodeId self, recording::records::Sink& out) : self_(self), out_(out) {}
  template <class Record> void each(const Record& record) {
    if constexpr (std::is_same_v<Record, recording::records::FaultActivity>) {
      if (!is_mine(record.node)) return;
    } else if constexpr (std::is_same_v<Record, recording::records::GuardianIntervention>) {
      if (!is_mine(record.branch)) return;
    } else if constexpr (std::is_same_v<Record, recording::records::ChannelFrame>) {
      if (!is_mine(record.sender)) return;
    }
    out_.on(record);
  }

 private:
  bool is_mine(NodeId node) const { return node == self_ || (node == kNoNode && self_ == NodeId{}); }

  NodeId self_;
  recording::records::Sink& out_;
};

}  // namespace ttf::sim::processes
