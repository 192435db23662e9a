// A prover decides whether offsets exist: the interface between the solver and a leaf with a library (smt/).
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "schedules/synthesis/problem.h"

namespace ttf::schedules::synthesis::solver {

struct Verdict {
  enum class Kind { kFeasible, kInfeasible, kUnknown } kind = Kind::kUnknown;
  Solution solution;  // if feasible
  double spent = 0;   // the share of the prover's steps
};

// Limits on objectives: the sum of weight * age over chains, the last end less the first beginning of activities.
struct SumLimit {
  std::vector<std::size_t> chains;
  std::vector<Ticks> weights;  // by `chains`
  Ticks most = 0;
};
struct SpanLimit {
  std::vector<std::size_t> activities;
  Ticks most = 0;
};

// A question: does the problem, with the chains' largest ages as they stand in it, have offsets that keep the limits, too?
struct Question {
  const Problem& problem;
  std::vector<SumLimit> sums;
  std::vector<SpanLimit> spans;
};

// Offers offsets that keep all but that activities overlap. Returns offsets that keep all, if some are found close to them.
using Repair = std::function<std::optional<Solution>(const Solution& almost)>;

class Prover {
 public:
  virtual ~Prover() = default;
  // Spends at most a share of its steps, in 0..1. Each answer is a proof, or offsets.
  virtual Verdict decide(const Question& question, double share, const Repair& repair) = 0;
};

}  // namespace ttf::schedules::synthesis::solver
