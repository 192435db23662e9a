// Tells the events of a FlexRay trial in words: the fault's acts, the guardians' interventions, the nodes' changes of
// state with their causes, and the checks.
#pragma once

#include "experiments/campaign/flexray/trial_story.h"
#include "experiments/campaign/outcome.h"
#include "schedules/model/cluster.h"

namespace ttf::experiments::campaign::flexray {

class StoryInWords final : public TrialStory {
 public:
  StoryInWords(const schedules::model::Cluster& cluster, Story& story) : cluster_(cluster), story_(story) {}

  void state_changed(NodeId node, bus::poc::PocKind from, const bus::poc::PocStep& step, TrueTime at) override;
  void fault_acts(const recording::records::FaultActivity& activity) override;
  void guardian_intervened(const sim::medium::StarCoupler::Intervention& intervention) override;
  void judged(const evaluation::faults::Judgement& judgement) override;

 private:
  const schedules::model::Cluster& cluster_;
  Story& story_;
};

}  // namespace ttf::experiments::campaign::flexray
