// Which fault a campaign injects as its n-th: a pure function of the campaign's seed and n, the same in every variant
// and for any number of workers.
//
// The hypothesis is FlexRay's: one node fails, in whatever way, or one channel does. Outside of it, and counted apart:
// noise and transients on both channels at once, and a lone coldstart node, for which all the others have to be without
// supply.
#pragma once

#include <cstdint>
#include <string>

#include "experiments/campaign/file.h"
#include "faults/plan.h"
#include "schedules/model/cluster.h"

namespace ttf::experiments::campaign {

struct DrawnFault {
  faults::Fault fault;     // resolved
  bool starts_up = false;  // it meets a start-up
};

bool in_hypothesis(const faults::Fault& fault);

// `cluster`: with both channels, whichever variant it is injected in.
DrawnFault draw_fault(const CampaignFile& campaign, const schedules::model::Cluster& cluster, std::uint32_t index);

// Its keys as in a fault plan, but for kind and node, in one cell of a table: "from: 5 ns; receivers: [fusion+laser]".
std::string parameters_text(const faults::Fault& fault, const schedules::model::Cluster& cluster);

}  // namespace ttf::experiments::campaign
