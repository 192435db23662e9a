// The choices of a plan that are no instants: the length of the cycle, the payload of static slots, how often each sensor
// measures, and the channel of lists that have one. Each makes a candidate, and all other periods follow.
//
//   Tasks and lists have the repetitions that follow from those of sensors (schedules/left_out/periods.h).
//   A fragment whose layout is left out has the payload's length, and as many elements as it holds.
//
// FlexRay's parameters that the plan leaves out follow from the length of the cycle (annex B, 2.1 Rev. A):
//   gMacroPerCycle = gdCycle / gdMacrotick; gdNIT and gNumberOfStaticSlots by constraint 18, with as many slots as fit beside
//   100 macroticks for offset correction; pMicroPerCycle = gdCycle / pdMicrotick; pRateCorrectionOut as two clocks of the
//   worst drifts need; pdListenTimeout = 2 (pMicroPerCycle + pRateCorrectionOut).
#pragma once

#include <optional>
#include <vector>

#include "core/time.h"
#include "schedules/model/cluster.h"
#include "schedules/synthesis/plan/plan.h"

namespace ttf::schedules::synthesis::instants {

inline constexpr std::size_t kMostCandidates = 20'000;

struct Candidate {
  Duration cycle{};
  std::vector<int> repetitions;  // by sensor; that of the file where it says one
  int payload = 0;               // bytes; 0: that of the file
  // The channels of the lists in Plan::one_channel, in this order; without any, lists have their own.
  std::vector<model::Channels> channels;
};

// Returns all candidates within the plan's lengths, payloads and rates, short cycles first, then short payloads; at most kMostCandidates + 1.
std::vector<Candidate> candidates(const plan::Plan& plan);

// A plan whose periods and parameters are chosen. Instants are still left out.
struct Timed {
  model::Cluster cluster;                // with the candidate's parameters and repetitions
  std::vector<plan::PlannedList> lists;  // with repetitions
};
// Returns none where a parameter would leave its range, or a fixed instant the cycle.
std::optional<Timed> timed(const plan::Plan& plan, const Candidate& candidate);

}  // namespace ttf::schedules::synthesis::instants
