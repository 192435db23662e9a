// Sums the counts of a drive's live media, node by node, from its logs.
//
// A record counts from the start of its process, so the newest one suffices. If a count or the local time
// decreases, the node has a new process; the last record of the old one then joins the sum.
#pragma once

#include <map>

#include "core/ids.h"
#include "recording/records/records.h"

namespace ttf::evaluation::lateness {

class MediumSums final : public recording::records::Sink {
 public:
  // Returns the nodes with counts, by id; empty in virtual time. The stamp is that of the newest record.
  std::map<NodeId, recording::records::MediumCounts> nodes() const;

  using recording::records::Sink::on;
  void on(const recording::records::MediumCounts&) override;

 private:
  struct Reported {
    recording::records::MediumCounts before;  // from the node's former processes
    recording::records::MediumCounts newest;  // from its present process
  };
  std::map<NodeId, Reported> reported_;
};

}  // namespace ttf::evaluation::lateness
