// A campaign over FlexRay: its cluster is wired anew in every variant, and its controllers have no hosts' tasks.
#pragma once

#include <vector>

#include "experiments/campaign/campaign_bus.h"

namespace ttf::experiments::campaign::flexray {

// Returns the campaign's cluster, wired as in the variant and proved consistent; all its nodes are on FlexRay.
// Throws InputError.
schedules::model::Cluster cluster_of(const CampaignFile& campaign, const Variant& variant);

class Bus final : public CampaignBus {
 public:
  explicit Bus(const CampaignFile& campaign);  // throws InputError

  const schedules::model::Cluster& variant(std::size_t index) const { return variants_[index]; }

  const Words& words() const override { return words_; }
  const schedules::model::Cluster& cluster() const override { return base_; }  // a bus of both channels
  DrawnFault draw(std::uint32_t index) const override;
  bool in_hypothesis(const faults::Fault& fault) const override;
  FaultOutcome run(std::size_t variant, const DrawnFault& drawn, std::uint32_t index, Story* story) const override;
  bool has_trait(std::size_t variant) const override { return campaign_.variants[variant].guarded(); }
  bool is_harmless(std::size_t variant, const faults::Fault& fault) const override {
    return has_trait(variant) && in_hypothesis(fault);
  }
  std::optional<Expectation> expectation() const override;

 private:
  const CampaignFile campaign_;
  const schedules::model::Cluster base_;
  std::vector<schedules::model::Cluster> variants_;  // in the file's order
  Words words_;
};

}  // namespace ttf::experiments::campaign::flexray
