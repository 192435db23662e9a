// Draws the n-th fault of a campaign: a pure function of the campaign's seed and n, the same in every variant
// and for any number of workers.
//
// The hypothesis is FlexRay's: one node fails in any way, or one channel does. Two classes are outside it and
// counted apart: noise and transients on both channels at once, and a lone coldstart node, which needs all
// others without supply.
#pragma once

#include <cstdint>

#include "experiments/campaign/file.h"
#include "experiments/campaign/outcome.h"
#include "faults/plan.h"
#include "schedules/model/cluster.h"

namespace ttf::experiments::campaign::flexray {

bool in_hypothesis(const faults::Fault& fault);

// `cluster` has both channels, whatever the variant.
DrawnFault draw_fault(const CampaignFile& campaign, const schedules::model::Cluster& cluster, std::uint32_t index);

}  // namespace ttf::experiments::campaign::flexray
