#include "experiments/campaign/flexray/story_in_words.h"

#include <fmt/format.h>

#include "bus/poc/reason.h"
#include "experiments/campaign/judged.h"
#include "recording/records/enumerations.h"

namespace ttf::experiments::campaign::flexray {
void StoryInWords::state_changed(NodeId node, bus::poc::PocKind from, const bus::poc::PocStep& step, TrueTime at) {
  const std::string_view consequence = to_text(step.consequence);
  story_.say(at, fmt::format("{}: {} -> {}: {}{}{}", cluster_.node(node).name, to_text(from), to_text(step.next.kind),
                             to_text(step.reason), consequence.empty() ? "" : "; ", consequence));
}

void StoryInWords::fault_acts(const recording::records::FaultActivity& activity) {
  story_.say(activity.at, fmt::format("fault {}: {}", activity.kind, activity.text),
             activity.what == recording::records::FaultAct::kActs ? Story::Of::kFault : Story::Of::kOthers);
}

void StoryInWords::guardian_intervened(const sim::medium::StarCoupler::Intervention& intervention) {
  const bool cut = intervention.reason == bus::guardian::GuardianReason::kForwarded;
  story_.say(intervention.at,
             fmt::format("guardian of {} {} {} of {}{}{}", letter(intervention.channel), cut ? "cuts off" : "blocks",
                         to_text(intervention.signal),
                         intervention.branch == kNoNode ? "nobody" : cluster_.node(intervention.branch).name,
                         cut ? "" : ": ", cut ? "" : bus::guardian::to_text(intervention.reason)),
             Story::Of::kGuardians);
}

void StoryInWords::judged(const evaluation::faults::Judgement& judgement) {
  tell(judgement, evaluation::faults::kAllChecks, story_);
}

}  // namespace ttf::experiments::campaign::flexray
