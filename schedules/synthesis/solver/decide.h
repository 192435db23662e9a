// Whether offsets exist: coarse searches first, then a search over whole turns, then over all ticks, then the prover.
#pragma once

#include "schedules/synthesis/solver/model.h"
#include "schedules/synthesis/solver/prover.h"
#include "schedules/synthesis/solver/solve.h"

namespace ttf::schedules::synthesis::solver {

class Decider {
 public:
  Decider(const Effort& effort, Prover* prover);

  // Lets the prover and the search over turns spend their steps anew, for another objective.
  void renew();

  // Every solution that they return has passed the checker.
  Verdict decide(const Question& question);  // search, then prove
  Verdict search(const Question& question);
  Verdict prove(const Question& question);  // kUnknown without a prover
  // Whether a few chains' largest ages alone, tried from the tightest on, cannot be kept. It is a proof for all of the question.
  bool few_chains_contradict(const Question& question);
  bool can_prove() const { return prover_ != nullptr; }
  // The way to the last answer: "placement", "exhausted", "integers", "windows and precedences" or "".
  const std::string& way() const { return way_; }

 private:
  Verdict turned(const Question& question, const Model& model);
  Verdict asked(const Question& question, double share, const Repair& repair);
  std::optional<Solution> repaired(const Question& question, const Solution& almost);

  Effort effort_;
  Prover* prover_;
  double left_ = 0;          // the prover's steps that may still be spent
  std::int64_t splits_ = 0;  // the splits of turns that are left
  std::string way_;
};

// Whether offsets keep all of a question, by the checker.
bool keeps(const Question& question, const Solution& solution);

}  // namespace ttf::schedules::synthesis::solver
