// A campaign over a CAN of a cluster: its controllers with the full traffic of the schedule. The variants differ by how a
// controller recovers that is bus off.
#pragma once

#include <cstddef>

#include "experiments/campaign/campaign_bus.h"
#include "experiments/campaign/can/trial.h"

namespace ttf::experiments::campaign::can {

class Bus final : public CampaignBus {
 public:
  // Throws InputError: an unknown CAN, one with fewer than three nodes, a message whose response time has no bound.
  explicit Bus(const CampaignFile& campaign);

  Setting setting() const { return {campaign_, cluster_, bus_}; }

  const Words& words() const override { return words_; }
  const schedules::model::Cluster& cluster() const override { return cluster_; }
  DrawnFault draw(std::uint32_t index) const override;
  bool in_hypothesis(const faults::Fault&) const override { return true; }  // one node fails
  FaultOutcome run(std::size_t variant, const DrawnFault& drawn, std::uint32_t index, Story* story) const override;
  bool has_trait(std::size_t variant) const override;
  bool is_harmless(std::size_t variant, const faults::Fault& fault) const override;
  std::optional<Expectation> expectation() const override;

 private:
  const CampaignFile campaign_;
  const schedules::model::Cluster cluster_;
  const std::size_t bus_;
  Words words_;
};

}  // namespace ttf::experiments::campaign::can
