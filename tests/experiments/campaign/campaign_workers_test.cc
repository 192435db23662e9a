// A campaign has the same results with any number of workers, and from shards put together.
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "core/errors.h"
#include "experiments/campaign/campaign.h"
#include "experiments/campaign/csv.h"
#include "tests/experiments/campaign/small_campaign.h"

namespace ttf::experiments::campaign {
namespace {

// Some times as many faults as a worker takes at once.
class CampaignWorkers : public testing::Test {
 protected:
  std::vector<FaultResult> run(unsigned workers, results::Shard shard = {}) const {
    return run_campaign(campaign_, *bus_, shard, workers, nullptr);
  }
  std::string csv(const std::vector<FaultResult>& results) const { return campaign_csv(campaign_, *bus_, results); }
  const CampaignFile campaign_ = small_campaign(40);
  const std::unique_ptr<const CampaignBus> bus_ = bus_of(campaign_);
};

TEST_F(CampaignWorkers, TheSameForAnyNumber) {
  const std::string one = csv(run(1));
  for (const unsigned workers : {2u, 8u}) EXPECT_EQ(csv(run(workers)), one) << workers;
}

TEST_F(CampaignWorkers, ShardsPutTogetherAreTheWhole) {
  std::vector<std::vector<FaultResult>> shards;
  for (std::uint32_t part = 0; part < 3; ++part)
    shards.push_back(read_campaign_csv(campaign_, *bus_, csv(run(2, {part, 3})), "shard"));
  EXPECT_EQ(csv(merged(campaign_, shards)), csv(run(2)));
  shards.pop_back();
  EXPECT_THROW(merged(campaign_, shards), InputError);
  shards.push_back(shards.front());
  EXPECT_THROW(merged(campaign_, shards), InputError);
}

}  // namespace
}  // namespace ttf::experiments::campaign
