// A trial: one fault in one cluster. It simulates controllers on clocks of their own, with the fault and the
// judge.
//
// Every host writes its lists anew in every cycle (trial_host.h), and restarts a halted controller after the
// campaign's delay (trial_simulation.h). A trial is a pure function of campaign, wiring and index: clocks, times of
// power-on (trial_draws.h) and the fault's draws come from streams of that index.
#pragma once

#include <cstdint>
#include <optional>

#include "experiments/campaign/draw.h"
#include "experiments/campaign/trial_story.h"
#include "schedules/model/cluster.h"

namespace ttf::experiments::campaign {

// The outcome of one fault; times in nanoseconds.
struct FaultOutcome {
  bool activated = false;            // the fault acted
  bool starts_without = true;        // for a start-up: all nodes became active without the fault
  std::uint16_t seen_by_others = 0;  // bits by Check
  std::uint16_t seen_by_itself = 0;
  std::uint8_t harms = 0;                     // bits by Harm
  NodeId harmed = kNoNode, sender = kNoNode;  // those in the first harm, as in Judgement
  int slot = 0;
  std::int16_t still_out = 0;  // nodes that lost normal active and did not come back
  std::optional<std::int64_t> detected_after, passive_after, halt_after;  // after the fault's first act
  std::optional<std::int64_t> harmed_after;
  std::optional<std::int64_t> reintegrated_after;  // Judgement::reintegration

  bool operator==(const FaultOutcome&) const = default;
};

// `cluster` is wired (cluster_of()). `story` may be null. `bit_true`: the medium encodes and decodes every
// frame; the outcome is the same.
FaultOutcome run_trial(const CampaignFile& campaign, const schedules::model::Cluster& cluster, const DrawnFault& drawn,
                       std::uint32_t index, TrialStory* story = nullptr, bool bit_true = false);

}  // namespace ttf::experiments::campaign
