// Draws the n-th fault of a campaign on a CAN: a pure function of the campaign's seed and n.
#pragma once

#include <cstddef>
#include <cstdint>

#include "experiments/campaign/file.h"
#include "experiments/campaign/outcome.h"
#include "schedules/model/cluster.h"

namespace ttf::experiments::campaign::can {

DrawnFault draw_fault(const CampaignFile& campaign, const schedules::model::Cluster& cluster, std::size_t bus,
                      std::uint32_t index);

}  // namespace ttf::experiments::campaign::can
