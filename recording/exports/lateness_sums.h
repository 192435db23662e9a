// How late the processes of a run were, node by node, added up from the histograms in its logs.
//
// A histogram tells everything since its process began, so that the newest holds all before it; where a count, or the
// local time, has become less, the process is another one, and what the former told is added to it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>

#include "core/ids.h"
#include "recording/records/binned_durations.h"
#include "recording/records/records.h"

namespace ttf::recording::exports {

// In real time.
struct NodeLateness {
  records::BinnedDurations wake_ups;    // of the node's process, at what it had to do
  records::BinnedDurations floor;       // of a plain periodic thread beside it
  records::BinnedDurations departures;  // of its frames, behind their action points
  records::BinnedDurations arrivals;    // of others' frames, behind their action points on its clock
  records::BinnedDurations transits;    // of what came from its own host: from its sender to the node's process
};

class LatenessSums final : public records::Sink {
 public:
  // Nodes that told of anything, by id; none in virtual time.
  std::map<NodeId, NodeLateness> nodes() const;

  using records::Sink::on;
  void on(const records::LatenessHistogram&) override;

 private:
  static constexpr std::size_t kKinds = records::kLatenessOfTransits;
  struct Told {
    records::BinnedDurations before;  // by the node's former processes
    records::BinnedDurations newest;  // by its present one
    LocalTime at{};                   // when it did
  };
  std::map<NodeId, std::array<Told, kKinds>> told_;
};

}  // namespace ttf::recording::exports
