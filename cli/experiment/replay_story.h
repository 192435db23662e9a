// Tells one fault of a campaign in the order of time: its acts, the guardians' interventions, and the nodes'
// changes of state with their causes.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "experiments/campaign/trial.h"
#include "schedules/model/cluster.h"

namespace ttf::cli::experiment {

class ReplayStory final : public experiments::campaign::TrialStory {
 public:
  explicit ReplayStory(const schedules::model::Cluster& cluster) : cluster_(cluster) {}

  void state_changed(NodeId node, bus::poc::PocKind from, const bus::poc::PocStep& step, TrueTime at) override;
  void fault_acts(const recording::records::FaultActivity& activity) override;
  void guardian_intervened(const sim::medium::StarCoupler::Intervention& intervention) override;
  void judged(const evaluation::faults::Judgement& judgement) override;
  // Prints the story; events of one instant keep the order of their arrival.
  void finish();

 private:
  static constexpr std::uint64_t kShown = 12;  // for the fault's acts, and for the guardians'
  enum class Of : std::uint8_t { kOthers, kFault, kGuardians };
  struct Line {
    TrueTime at;
    Of of;
    std::string text;
  };
  void say(TrueTime at, std::string text, Of of = Of::kOthers) { lines_.push_back({at, of, std::move(text)}); }

  const schedules::model::Cluster& cluster_;
  std::vector<Line> lines_;  // in order of arrival: guardians' acts and detections come long afterwards
};

}  // namespace ttf::cli::experiment
