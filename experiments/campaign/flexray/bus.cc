#include "experiments/campaign/flexray/bus.h"

#include <fmt/format.h>

#include "bus/poc/reason.h"
#include "core/counted.h"
#include "evaluation/faults/checks.h"
#include "experiments/campaign/flexray/draw.h"
#include "experiments/campaign/flexray/trial.h"
#include "experiments/campaign/judged.h"
#include "experiments/campaign/outcome.h"
#include "recording/records/enumerations.h"
#include "schedules/check/checker.h"
#include "schedules/model/cluster.h"
#include "sim/drives/drive.h"

namespace ttf::experiments::campaign::flexray {
namespace {

// Reports the events of a FlexRay trial in words: the fault's acts, the guardians' interventions, the nodes' changes of
// state with their causes, and the checks.
class StoryInWords final : public TrialStory {
 public:
  StoryInWords(const schedules::model::Cluster& cluster, Story& story) : cluster_(cluster), story_(story) {}

  void state_changed(NodeId node, bus::poc::PocKind from, const bus::poc::PocStep& step, TrueTime at) override {
    const std::string_view consequence = to_text(step.consequence);
    story_.say(at, fmt::format("{}: {} -> {}: {}{}{}", cluster_.node(node).name, to_text(from), to_text(step.next.kind),
                               to_text(step.reason), consequence.empty() ? "" : "; ", consequence));
  }
  void fault_acts(const recording::records::FaultActivity& activity) override {
    story_.say(activity.at, fmt::format("fault {}: {}", activity.kind, activity.text),
               activity.what == recording::records::FaultAct::kActs ? Story::Of::kFault : Story::Of::kOthers);
  }
  void guardian_intervened(const sim::medium::StarCoupler::Intervention& intervention) override {
    const bool cut = intervention.reason == bus::guardian::GuardianReason::kForwarded;
    story_.say(intervention.at,
               fmt::format("guardian of {} {} {} of {}{}{}", letter(intervention.channel), cut ? "cuts off" : "blocks",
                           to_text(intervention.signal),
                           intervention.branch == kNoNode ? "nobody" : cluster_.node(intervention.branch).name,
                           cut ? "" : ": ", cut ? "" : to_text(intervention.reason)),
               Story::Of::kGuardians);
  }
  void judged(const evaluation::faults::Judgement& judgement) override {
    report(judgement, evaluation::faults::kAllChecks, story_);
  }

 private:
  const schedules::model::Cluster& cluster_;
  Story& story_;
};

using evaluation::faults::Check;
using schedules::model::Channels;

std::string_view short_name(Check check) {
  switch (check) {
    case Check::kBoundary: return "bound.";
    case Check::kConflict: return "confl.";
    case Check::kNoFrame: return "no fr.";
    case Check::kUnexpected: return "unexp.";
    case Check::kMissingTerm: return "missing";
    case Check::kGuardian: return "guard";
    case Check::kSyntax:
    case Check::kContent:
    case Check::kLimit:
    case Check::kPassive:
    case Check::kHalt: return name_of(check);
  }
  return "";
}

Words words_for(Duration cycle) {
  Words words;
  for (const Check check : evaluation::faults::kAllChecks) {
    words.checks.push_back(name_of(check));
    words.check_columns.push_back(short_name(check));
  }
  for (const evaluation::faults::Harm harm : evaluation::faults::kAllHarms) words.harms.push_back(name_of(harm));
  words.trait = "guardian and two channels";
  words.unit_name = "cycles";
  words.unit = cycle;
  words.unit_beside_ms = "cycle";
  return words;
}

}  // namespace

schedules::model::Cluster cluster_of(const CampaignFile& campaign, const Variant& variant) {
  schedules::model::Cluster cluster = read_cluster_of(campaign);
  cluster.topology = variant.topology;
  cluster.guardian = variant.guardian;
  Findings findings;
  for (schedules::model::Node& node : cluster.nodes) {
    if (!node.flexray) {
      findings.add(
          cluster.finding(node.line, "nodes." + node.name, "", "must be on FlexRay: a campaign has controllers only"));
      continue;
    }
    if (variant.channels == Channels::kA) {
      node.flexray->pChannels = Channels::kA;
      node.flexray->pWakeupChannel = schedules::model::Channel::kA;
    }
  }
  findings.throw_if_any();
  if (variant.channels == Channels::kA)
    for (schedules::model::FrameSlot& frame : cluster.frames) frame.channels = Channels::kA;
  if (auto wrong = schedules::check::check(cluster); !wrong.empty()) throw InputError(std::move(wrong));
  sim::drives::check_described(cluster);
  return cluster;
}

Bus::Bus(const CampaignFile& campaign)
    : campaign_(campaign), base_(cluster_of(campaign, {})), words_(words_for(base_.cycle())) {
  for (const Variant& variant : campaign.variants) variants_.push_back(cluster_of(campaign, variant));
}

DrawnFault Bus::draw(std::uint32_t index) const { return draw_fault(campaign_, base_, index); }

bool Bus::in_hypothesis(const faults::Fault& fault) const { return flexray::in_hypothesis(fault); }

FaultOutcome Bus::run(std::size_t variant, const DrawnFault& drawn, std::uint32_t index, Story* story) const {
  if (story == nullptr) return run_trial(campaign_, variants_[variant], drawn, index);
  StoryInWords words(variants_[variant], *story);
  return run_trial(campaign_, variants_[variant], drawn, index, &words);
}

std::optional<Expectation> Bus::expectation() const {
  if (!campaign_.expected_harmed) return std::nullopt;
  const std::int64_t most = *campaign_.expected_harmed;
  return Expectation{"harmed_with_guardian", most,
                     fmt::format("at most {} of the hypothesis {} harm with guardian and both channels",
                                 counted(static_cast<std::uint64_t>(most), "fault"), most == 1 ? "does" : "do")};
}

}  // namespace ttf::experiments::campaign::flexray
