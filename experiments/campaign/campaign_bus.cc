#include "experiments/campaign/campaign_bus.h"

#include "experiments/campaign/can/bus.h"
#include "experiments/campaign/flexray/bus.h"

namespace ttf::experiments::campaign {

std::unique_ptr<const CampaignBus> bus_of(const CampaignFile& campaign) {
  if (campaign.is_on_can()) return std::make_unique<can::Bus>(campaign);
  return std::make_unique<flexray::Bus>(campaign);
}

}  // namespace ttf::experiments::campaign
