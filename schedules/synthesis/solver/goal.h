// An objective over whole ticks as a threshold: what has to hold for its value to be at most so much.
#pragma once

#include <vector>

#include "schedules/synthesis/problem.h"
#include "schedules/synthesis/solver/prover.h"
#include "schedules/synthesis/solver/solve.h"

namespace ttf::schedules::synthesis::solver {

// The problem with limits that grow tighter, objective by objective.
struct Tightened {
  Problem problem;
  std::vector<SumLimit> sums;
  std::vector<SpanLimit> spans;
  Question question() const { return {problem, sums, spans}; }
};

class Goal {
 public:
  // `original` has the largest ages from which lateness counts.
  Goal(const Problem& original, const Objective& objective);

  Ticks value(const Solution& solution) const;
  // A value that no offsets fall below.
  Ticks least() const;
  // Asks for a value of at most `most`.
  void tighten(Tightened& tightened, Ticks most) const;

 private:
  const Problem& problem_;
  Objective::Kind kind_;
  std::vector<std::size_t> which_;
  std::vector<Ticks> weights_;  // by which_
};

}  // namespace ttf::schedules::synthesis::solver
