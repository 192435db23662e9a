// Draws the n-th fault of a campaign: a pure function of the campaign's seed and n, the same in every variant
// and for any number of workers.
//
// The hypothesis is FlexRay's: one node fails in any way, or one channel does. Two classes are outside it and
// counted apart: noise and transients on both channels at once, and a lone coldstart node, which needs all
// others without supply.
#pragma once

#include <cstdint>
#include <string>

#include "experiments/campaign/file.h"
#include "faults/plan.h"
#include "schedules/model/cluster.h"

namespace ttf::experiments::campaign {

struct DrawnFault {
  faults::Fault fault;     // resolved
  bool starts_up = false;  // injected into a start-up
};

bool in_hypothesis(const faults::Fault& fault);

// `cluster` has both channels, whatever the variant.
DrawnFault draw_fault(const CampaignFile& campaign, const schedules::model::Cluster& cluster, std::uint32_t index);

// Returns its keys as in a fault plan, without kind and node, for one cell of a table: "from: 5 ns; receivers:
// [fusion+laser]".
std::string parameters_text(const faults::Fault& fault, const schedules::model::Cluster& cluster);

}  // namespace ttf::experiments::campaign
