// A campaign's results as a table: one line per fault and variant; what a shard leaves, and what is put together again.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "experiments/campaign/campaign.h"

namespace ttf::experiments::campaign {

std::string campaign_csv(const CampaignFile& campaign, const CampaignClusters& clusters,
                         std::span<const FaultResult> results);

// The results of one such table, of this very campaign: each line's fault is drawn again, and must be the same. `name`:
// for messages. Throws InputError.
std::vector<FaultResult> read_campaign_csv(const CampaignFile& campaign, const CampaignClusters& clusters,
                                           const std::string& text, const std::string& name);

// Puts the results of several shards together, by index. Throws InputError where a fault is there twice, or some is
// missing.
std::vector<FaultResult> merged(const CampaignFile& campaign, std::vector<std::vector<FaultResult>> shards);

}  // namespace ttf::experiments::campaign
