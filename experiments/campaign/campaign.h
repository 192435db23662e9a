// Runs a whole campaign: every fault in every variant, on several workers. Results are gathered by index, so
// any number of workers gives the same, and the merged shards give the same as one run.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "experiments/campaign/campaign_bus.h"
#include "experiments/campaign/file.h"
#include "experiments/campaign/outcome.h"
#include "experiments/results/shard.h"

namespace ttf::experiments::campaign {

struct FaultResult {
  std::uint32_t index = 0;
  DrawnFault drawn;
  std::vector<FaultOutcome> outcomes;  // by variant
};

// `progress` receives the number of faults done, now and then, on the calling thread.
std::vector<FaultResult> run_campaign(const CampaignFile& campaign, const CampaignBus& bus, results::Shard shard,
                                      unsigned workers, const std::function<void(std::uint64_t)>& progress);

}  // namespace ttf::experiments::campaign
