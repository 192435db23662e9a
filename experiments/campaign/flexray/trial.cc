#include "experiments/campaign/flexray/trial.h"

#include <algorithm>
#include <optional>

#include "evaluation/faults/reach.h"
#include "experiments/campaign/flexray/trial_simulation.h"
#include "faults/believed_schedule.h"
#include "schedules/model/wire_times.h"
#include "sim/medium/disturbance.h"

namespace ttf::experiments::campaign::flexray {
namespace {

constexpr int kCyclesToSettle = 2;  // after the last node became active

template <class Times> std::uint16_t bits_of(const Times& times) {
  unsigned bits = 0;
  for (std::size_t i = 0; i < times.size(); ++i) bits |= times[i].has_value() ? 1u << i : 0u;
  return static_cast<std::uint16_t>(bits);
}

FaultOutcome outcome_of(const evaluation::faults::Judgement& judgement,
                        const sim::faults::Injector::Activation& activation) {
  FaultOutcome outcome;
  outcome.activated = activation.times > 0;
  outcome.seen_by_others = bits_of(judgement.seen_by_others);
  outcome.seen_by_itself = bits_of(judgement.seen_by_itself);
  outcome.harms = static_cast<std::uint8_t>(bits_of(judgement.harms));
  outcome.still_out = static_cast<std::int16_t>(judgement.still_out);
  const auto after = [&](const evaluation::faults::Judgement::Since& since) {
    return since ? std::optional(std::max<std::int64_t>(0, (*since - activation.first).ns)) : std::nullopt;
  };
  outcome.detected_after = after(judgement.detected());
  outcome.passive_after = after(judgement.passive);
  outcome.halt_after = after(judgement.halt);
  if (judgement.reintegration) outcome.reintegrated_after = judgement.reintegration->ns;
  const evaluation::faults::Judgement::Harmed* first = nullptr;
  for (const auto& harm : judgement.harms)
    if (harm && (first == nullptr || harm->first < first->first)) first = &*harm;
  if (first != nullptr) {
    outcome.harmed = first->node;
    outcome.sender = first->sender;
    outcome.frame_id = first->slot;
    outcome.harmed_after = after(first->first);
  }
  return outcome;
}

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
