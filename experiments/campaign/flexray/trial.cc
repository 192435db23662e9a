#include "experiments/campaign/flexray/trial.h"

#include <optional>

#include "evaluation/faults/reach.h"
#include "experiments/campaign/flexray/trial_simulation.h"
#include "experiments/campaign/judged.h"
#include "faults/believed_schedule.h"
#include "schedules/model/wire_times.h"
#include "sim/medium/disturbance.h"

namespace ttf::experiments::campaign::flexray {
namespace {

constexpr int kCyclesToSettle = 2;  // after the last node became active

// A start-up without the fault: its findings are not effects of the fault.
struct UsualStartup {
  bool completes = false;
  TrueTime settled{};
  std::array<bool, evaluation::faults::kAllChecks.size()> seen{};
};
UsualStartup usual_startup(const TrialSetting& setting, evaluation::faults::JudgeSettings judge, TrueTime end) {
  judge.faulty.assign(setting.cluster.nodes.size(), false);
  TrialSimulation simulation(setting, std::nullopt, judge);
  const std::optional<TrueTime> all_active = simulation.run_until_all_active(end);
  UsualStartup usual{all_active.has_value(), all_active.value_or(end) + setting.cluster.cycle() * kCyclesToSettle, {}};
  const evaluation::faults::Judgement& judgement = simulation.finish();
  for (std::size_t c = 0; c < evaluation::faults::kAllChecks.size(); ++c)
    usual.seen[c] = judgement.seen_by_others[c].has_value();
  return usual;
}

// Sets the time span of the fault.
void set_window(evaluation::faults::JudgeSettings& judge, const faults::Fault& fault) {
  const TrueTime from = trial_origin(judge.starts_up) + fault.from;
  judge.from = faults::changes_schedule(fault) ? TrueTime{} : from;
  judge.until = fault.duration == faults::Fault::kToTheEnd ? kNever<TrueTime> : from + fault.duration;
}

}  // namespace

FaultOutcome run_trial(const CampaignFile& campaign, const schedules::model::Cluster& cluster, const DrawnFault& drawn,
                       std::uint32_t index, TrialStory* story, bool bit_true) {
  const TrialSetting setting{campaign, cluster, index, bit_true};
  const int cycles = drawn.starts_up ? campaign.startup_cycles : campaign.steady_cycles;
  const TrueTime end = TrueTime{} + cluster.cycle() * cycles;
  evaluation::faults::JudgeSettings judge;
  judge.assumed_precision = assumed_precision(cluster.flexray);
  judge.starts_up = drawn.starts_up;
  bool starts_without = true;
  if (drawn.starts_up) {
    const UsualStartup usual = usual_startup(setting, judge, end);
    starts_without = usual.completes;
    judge.settled = usual.settled;
    judge.usual = usual.seen;
  }
  judge.faulty = evaluation::faults::named_by(drawn.fault, cluster);
  set_window(judge, drawn.fault);
  TrialSimulation simulation(setting, drawn.fault, judge, story);
  simulation.run_until(end);
  const evaluation::faults::Judgement& judgement = simulation.finish();
  if (story != nullptr) story->judged(judgement);
  FaultOutcome outcome = outcome_of(judgement, simulation.activation());
  outcome.starts_without = starts_without;
  return outcome;
}

}  // namespace ttf::experiments::campaign::flexray
