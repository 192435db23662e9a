// A trial: one fault in one cluster. It simulates controllers on clocks of their own, with the fault and the
// judge.
//
// Every host writes its lists anew in every cycle, and restarts a halted controller after the campaign's delay
// (trial_simulation.h). A trial is a pure function of campaign, wiring and index: clocks, times of power-on and the
// fault's draws come from streams of that index.
#pragma once

#include <cstdint>

#include "bus/poc/poc.h"
#include "core/ids.h"
#include "core/time.h"
#include "evaluation/faults/judge.h"
#include "experiments/campaign/file.h"
#include "experiments/campaign/outcome.h"
#include "recording/records/records.h"
#include "schedules/model/cluster.h"
#include "sim/medium/star_coupler.h"

namespace ttf::experiments::campaign::flexray {

// Receives the events of a trial, for a replay in words.
class TrialStory {
 public:
  virtual ~TrialStory() = default;
  virtual void state_changed(NodeId node, bus::poc::PocKind from, const bus::poc::PocStep& step, TrueTime at) = 0;
  virtual void fault_acts(const recording::records::FaultActivity& activity) = 0;
  virtual void guardian_intervened(const sim::medium::StarCoupler::Intervention& intervention) = 0;
  virtual void judged(const evaluation::faults::Judgement& judgement) = 0;
};

// `cluster` is wired (cluster_of()). `story` may be null. `bit_true`: the medium encodes and decodes every
// frame; the outcome is the same.
FaultOutcome run_trial(const CampaignFile& campaign, const schedules::model::Cluster& cluster, const DrawnFault& drawn,
                       std::uint32_t index, TrialStory* story = nullptr, bool bit_true = false);

}  // namespace ttf::experiments::campaign::flexray
