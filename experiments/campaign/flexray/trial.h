// A trial: one fault in one cluster. It simulates controllers on clocks of their own, with the fault and the
// judge.
//
// Every host writes its lists anew in every cycle, and restarts a halted controller after the
// campaign's delay (trial_simulation.h). A trial is a pure function of campaign, wiring and index: clocks, times of
// power-on and the fault's draws come from streams of that index.
#pragma once

#include <cstdint>

#include "experiments/campaign/file.h"
#include "experiments/campaign/flexray/trial_story.h"
#include "experiments/campaign/outcome.h"
#include "schedules/model/cluster.h"

namespace ttf::experiments::campaign::flexray {

// `cluster` is wired (cluster_of()). `story` may be null. `bit_true`: the medium encodes and decodes every
// frame; the outcome is the same.
FaultOutcome run_trial(const CampaignFile& campaign, const schedules::model::Cluster& cluster, const DrawnFault& drawn,
                       std::uint32_t index, TrialStory* story = nullptr, bool bit_true = false);

}  // namespace ttf::experiments::campaign::flexray
