// What the media of a run's nodes counted, added up from the counts in its logs.
//
// A record tells everything since its process began, so that the newest holds all before it; where a count, or the
// local time, has become less, the process is another one, and what the former told is added to it.
#pragma once

#include <map>

#include "core/ids.h"
#include "recording/records/records.h"

namespace ttf::evaluation::lateness {

class MediumSums final : public recording::records::Sink {
 public:
  // Nodes that told of anything, by id; none in virtual time. Their stamps are of what was told last.
  std::map<NodeId, recording::records::MediumCounts> nodes() const;

  using recording::records::Sink::on;
  void on(const recording::records::MediumCounts&) override;

 private:
  struct Told {
    recording::records::MediumCounts before;  // by the node's former processes
    recording::records::MediumCounts newest;  // by its present one
  };
  std::map<NodeId, Told> told_;
};

}  // namespace ttf::evaluation::lateness
