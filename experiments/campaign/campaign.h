// A whole campaign: every fault in every variant, on as many workers as there are. Results are gathered by index, so
// they are the same for any number of workers, and those of shards put together the same as of one run.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "experiments/campaign/file.h"
#include "experiments/campaign/trial.h"
#include "experiments/results/shard.h"

namespace ttf::experiments::campaign {

struct FaultResult {
  std::uint32_t index = 0;
  DrawnFault drawn;
  std::vector<FaultOutcome> outcomes;  // by variant
};

struct CampaignClusters {
  explicit CampaignClusters(const CampaignFile& campaign);  // throws InputError
  schedules::model::Cluster base;                           // faults are drawn in
  std::vector<schedules::model::Cluster> variants;          // in the file's order
};

// `progress`: called now and then by the calling thread, with how many faults are done.
std::vector<FaultResult> run_campaign(const CampaignFile& campaign, const CampaignClusters& clusters,
                                      results::Shard shard, unsigned workers,
                                      const std::function<void(std::uint64_t)>& progress);

}  // namespace ttf::experiments::campaign
