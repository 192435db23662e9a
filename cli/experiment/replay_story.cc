#include "cli/experiment/replay_story.h"

#include <fmt/format.h>

#include <algorithm>

#include "bus/poc/reason.h"
#include "core/counted.h"

namespace ttf::cli::experiment {
namespace {

std::string_view text(bus::ports::Signal signal) {
  switch (signal) {
    case bus::ports::Signal::kFrame: return "a frame";
    case bus::ports::Signal::kCas: return "a collision avoidance symbol";
    case bus::ports::Signal::kWakeup: return "a wake-up pattern";
    case bus::ports::Signal::kUndecodable: return "something undecodable";
  }
  return "";
}

}  // namespace

void ReplayStory::state_changed(NodeId node, bus::poc::PocKind from, const bus::poc::PocStep& step, TrueTime at) {
  const std::string_view consequence = bus::poc::to_text(step.consequence);
  say(at, fmt::format("{}: {} -> {}: {}{}{}", cluster_.node(node).name, bus::poc::to_text(from),
                      bus::poc::to_text(step.next.kind), bus::poc::to_text(step.reason),
                      consequence.empty() ? "" : "; ", consequence));
}

void ReplayStory::fault_acts(const recording::records::FaultActivity& activity) {
  say(activity.at, fmt::format("fault {}: {}", activity.kind, activity.text),
      activity.what == recording::records::kFaultActs ? Of::kFault : Of::kOthers);
}

void ReplayStory::guardian_intervened(const sim::medium::StarCoupler::Intervention& intervention) {
  const bool cut = intervention.reason == bus::guardian::GuardianReason::kForwarded;
  say(intervention.at,
      fmt::format("guardian of {} {} {} of {}{}{}", letter(intervention.channel), cut ? "cuts off" : "blocks",
                  text(intervention.signal),
                  intervention.branch == kNoNode ? "nobody" : cluster_.node(intervention.branch).name, cut ? "" : ": ",
                  cut ? "" : bus::guardian::to_text(intervention.reason)),
      Of::kGuardians);
}

void ReplayStory::judged(const evaluation::faults::Judgement& judgement) {
  for (const evaluation::faults::Check check : evaluation::faults::kAllChecks) {
    const auto c = static_cast<std::size_t>(check);
    if (judgement.seen_by_others[c])
      say(*judgement.seen_by_others[c], fmt::format("noticed by others: {}", name_of(check)));
    if (judgement.seen_by_itself[c])
      say(*judgement.seen_by_itself[c], fmt::format("noticed by itself: {}", name_of(check)));
  }
}

void ReplayStory::finish() {
  std::stable_sort(lines_.begin(), lines_.end(), [](const Line& a, const Line& b) { return a.at < b.at; });
  std::uint64_t acts = 0, interventions = 0;
  for (const Line& line : lines_) {
    if ((line.of == Of::kFault && ++acts > kShown) || (line.of == Of::kGuardians && ++interventions > kShown)) continue;
    fmt::print("  {:>10.3f} ms  cycle {:>6.2f}  {}\n", in_ms(line.at),
               in_units_of(cluster_.cycle(), line.at - TrueTime{}), line.text);
  }
  if (acts > kShown) fmt::print("  the fault acts {} more\n", counted(acts - kShown, "time"));
  if (interventions > kShown)
    fmt::print("  the guardians intervene {} more\n", counted(interventions - kShown, "time"));
}

}  // namespace ttf::cli::experiment
