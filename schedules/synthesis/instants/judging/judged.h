// The least value of a judge (judge.h) over the trials that are left.
//
// Each trial's bound is asked first. A trial whose bound is above the best value is dropped. In the others the search
// for ages proposes placements:
//   the least worst age
//   the same, where an age counts from the chain's own least on, once and twice
//   for each chain its least age
// From each of them the measurements are moved earlier and later (moves.h). At the end more effort raises the least
// bounds, one trial after the other. Placements, moves and effort are counted.
#pragma once

#include <cstdint>
#include <vector>

#include "schedules/synthesis/instants/judging/judge.h"
#include "schedules/synthesis/instants/judging/trial.h"

namespace ttf::schedules::synthesis::instants::judging {

struct Judged {
  double value = 0, bound = 0;
  std::vector<double> weights;  // by part: 1, or 1 over the least value that was found of it
  bool exact = true;            // a trial without a placement has none
};

// Leaves the best instants in each trial, and puts out those whose value is above the best. Without value: no trial is
// left.
Judged least_judged(const plan::Plan& plan, const Judge& judge, std::vector<Trial>& trials);

// Returns a bound of the judge's value, with these weights, over the trials as they are. It is at most `value`. Behind
// another judge these are the trials before it: their least value over all instants is not above that over the
// instants that the other judge left.
double least_bound(const plan::Plan& plan, const Judge& judge, std::vector<Trial> trials,
                   const std::vector<double>& weights, double value);

inline constexpr std::int64_t kProposalSteps = 20'000;  // placements for a proposal
inline constexpr int kMostMoves = 400;                  // the most for one trial
inline constexpr int kLeastEffort = 128;                // for a trial's first bound
inline constexpr std::int64_t kMostEffort = 50'000;     // for the bounds of all trials together, behind that

}  // namespace ttf::schedules::synthesis::instants::judging
