// A campaign's results as a table with one line per fault and variant, which a shard writes and the merge
// reads.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "experiments/campaign/campaign.h"

namespace ttf::experiments::campaign {

std::string campaign_csv(const CampaignFile& campaign, const CampaignBus& bus, std::span<const FaultResult> results);

// Reads the results of such a table, of this very campaign: each line's fault is drawn again and must be the
// same. `name` is the table's, for messages. Throws InputError.
std::vector<FaultResult> read_campaign_csv(const CampaignFile& campaign, const CampaignBus& bus,
                                           const std::string& text, const std::string& name);

// Merges the results of several shards, by index. Throws InputError if a fault is repeated or missing.
std::vector<FaultResult> merged(const CampaignFile& campaign, std::vector<std::vector<FaultResult>> shards);

}  // namespace ttf::experiments::campaign
