// From a plan to a cluster: the best candidate's best instants, by the objectives in their order.
//
// Each objective in turn is brought to its best value over all candidates, and held there for the objectives behind it. Equal
// candidates are left at the end: of them the one with the least sum of ages is taken, then the one with the shortest cycle.
// The result passes schedules/check. Ages are those that schedules/analysis bounds.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/errors.h"
#include "core/time.h"
#include "schedules/model/cluster.h"
#include "schedules/synthesis/instants/candidates.h"
#include "schedules/synthesis/instants/judging/judge.h"
#include "schedules/synthesis/instants/written.h"
#include "schedules/synthesis/plan/plan.h"

namespace ttf::schedules::synthesis::instants {

// An objective's value and the bound that it was held against: no instants within the plan have a better value than the bound.
// Ages and jitter are in milliseconds, slots are slots, room is a share. A judge has its own unit.
struct Reached {
  plan::Goal goal{};
  double value = 0, bound = 0;
  bool proven = false;  // the bound is the value
  // The way to the proof: "bound" (no instants are needed to see it), "all orders tried" by the search, "all choices tried" of
  // cycle and rates.
  std::string way;
  std::vector<double> weights{};  // by part of a judge (judging/judge.h)
  std::string supposes{};         // a condition of the bound without a proof (judging/judge.h); else empty
};

struct Synthesis {
  bool found = false;
  bool exact = false;  // not found: every candidate was searched through
  model::Cluster cluster;
  std::vector<Reached> reached;  // by objective
  std::vector<AgeBounds> ages;   // by chain
  Candidate candidate;           // the one that was taken
  std::size_t candidates = 0;    // all that the plan allows
  std::vector<Finding> refused;  // not found: what the check refused, in the plan's lines
};

// Throws InputError for a plan whose parts contradict each other at any instants: messages that fit no CAN, lists without a
// sender, parameters of FlexRay.
//
// Objectives above schedules need their judges, by goal.
Synthesis synthesize(const plan::Plan& plan, const judging::Judges& judges = {});

// Returns whether the plan has any solution: found, or not found and exact.
struct Feasible {
  bool found = false, exact = false;
};
Feasible feasible(const plan::Plan& plan);

// Returns whether instants that the search finds pass the check (schedules/check/checker.h).
bool passes(const plan::Plan& plan);

}  // namespace ttf::schedules::synthesis::instants
