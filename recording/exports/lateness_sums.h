// Sums the lateness of a drive's processes, node by node, from the histograms in its logs.
//
// A histogram counts from the start of its process, so the newest one suffices. If a count or the local time
// decreases, the node has a new process; the last histogram of the old one then joins the sum.
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
  records::BinnedDurations wake_ups;    // the acts of the node's process
  records::BinnedDurations floor;       // a plain periodic thread beside it
  records::BinnedDurations departures;  // its frames, behind their action points
  records::BinnedDurations arrivals;    // others' frames, behind their action points on its clock
  records::BinnedDurations transits;    // from sender to process, for frames of the same machine
};

class LatenessSums final : public records::Sink {
 public:
  // Returns the nodes with a histogram, by id; empty in virtual time.
  std::map<NodeId, NodeLateness> nodes() const;

  using records::Sink::on;
  void on(const records::LatenessHistogram&) override;

 private:
  static constexpr std::size_t kKinds = index_of(records::LatenessOf::kTransits);
  struct Reported {
    records::BinnedDurations before;  // from the node's former processes
    records::BinnedDurations newest;  // from its present process
    LocalTime at{};                   // local time of the newest histogram
  };
  std::map<NodeId, std::array<Reported, kKinds>> reported_;
};

}  // namespace ttf::recording::exports
