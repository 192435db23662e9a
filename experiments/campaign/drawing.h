// The draws that campaigns over all buses have in common, from the stream of one fault. Their order is part of a
// campaign: another order draws other faults.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/random.h"
#include "core/time.h"
#include "experiments/campaign/file.h"
#include "faults/plan.h"

namespace ttf::experiments::campaign {

class Drawing {
 public:
  Drawing(const CampaignFile& campaign, std::uint32_t index);

 protected:
  faults::FaultKind kind();  // by the campaign's weights
  faults::FaultDirection direction();
  void occasions(faults::Fault& fault);
  // Draws intervals of bursts from 10 us to `ratio` times that, evenly in the logarithm.
  void bursts(faults::Fault& fault, double ratio);
  // Draws receivers among these, in half of all cases; else all receive it so.
  void receivers(faults::Fault& fault, std::span<const NodeId> candidates);

  double uniform() { return draw_.uniform(); }
  Duration between(Duration low, Duration high) { return {draw_.integer(low.ns, high.ns)}; }
  int number(int low, int high) { return static_cast<int>(draw_.integer(low, high)); }
  template <class T> T one_of(const std::vector<T>& choices) {
    return choices[static_cast<std::size_t>(draw_.integer(0, static_cast<std::int64_t>(choices.size()) - 1))];
  }
  const CampaignFile& campaign() const { return campaign_; }

 private:
  const CampaignFile& campaign_;
  RandomStream draw_;
};

}  // namespace ttf::experiments::campaign
