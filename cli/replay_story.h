// One fault of a campaign in words: what the fault does, what the guardians keep from the others, and which nodes change their
// state and why, in the order of time.
#pragma once

#include <cstdint>
#include <string>

#include "experiments/fault_trial.h"

namespace ttf::cli {

class ReplayStory final : public experiments::TrialStory {
 public:
  explicit ReplayStory(const schedules::Cluster& cluster) : cluster_(cluster) {}

  void state_changed(NodeId node, bus::PocKind from, const bus::PocStep& step, TrueTime at) override;
  void fault_acts(const records::FaultActivity& activity) override;
  void guardian_intervened(const sim::StarCoupler::Intervention& intervention) override;
  void judged(const experiments::Judgement& judgement) override;
  // Says how much was left out.
  void finish();

 private:
  static constexpr std::uint64_t kShown = 12;   // acts of the fault, and as many of the guardians
  void say(TrueTime at, const std::string& text) const;

  const schedules::Cluster& cluster_;
  std::uint64_t acts_ = 0, interventions_ = 0;
};

}  // namespace ttf::cli
