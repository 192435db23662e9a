#include "experiments/campaign/drawing.h"

#include <cmath>

#include "core/check.h"

namespace ttf::experiments::campaign {

using faults::Fault;

Drawing::Drawing(const CampaignFile& campaign, std::uint32_t index)
    : campaign_(campaign), draw_({campaign.seed, index, Purpose::kCampaign, 0, 0}) {}

faults::FaultKind Drawing::kind() {
  std::int64_t sum = 0;
  for (const std::int64_t weight : campaign_.weights) sum += weight;
  std::int64_t left = draw_.integer(0, sum - 1);
  for (std::size_t k = 0; k < campaign_.weights.size(); ++k) {
    if (left < campaign_.weights[k]) return faults::kAllFaultKinds[k];
    left -= campaign_.weights[k];
  }
  TTF_CHECK(false, "{} beyond all weights", left);
}

faults::FaultDirection Drawing::direction() {
  return one_of(
      std::vector{faults::FaultDirection::kSend, faults::FaultDirection::kReceive, faults::FaultDirection::kBoth});
}

void Drawing::occasions(Fault& fault) {
  if (draw_.uniform() < 0.5) fault.probability = draw_.uniform(0.05, 1.0);
  if (draw_.uniform() < 0.25) fault.every = number(2, 8);
}

void Drawing::bursts(Fault& fault, double ratio) {
  const double ns = 1e4 * std::pow(ratio, draw_.uniform());
  fault.interval = Duration{static_cast<std::int64_t>(ns)};
  fault.jitter = draw_.uniform() < 0.5 ? Duration{} : between(Duration{}, fault.interval);
}

void Drawing::receivers(Fault& fault, std::span<const NodeId> candidates) {
  if (draw_.uniform() < 0.5) return;
  for (const NodeId node : candidates)
    if (node != fault.node && draw_.uniform() < 0.5) fault.receivers.push_back(node);
}

}  // namespace ttf::experiments::campaign
