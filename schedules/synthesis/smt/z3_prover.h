// The prover with Z3 (de Moura, Bjorner, TACAS 2008): the question as constraints over integers.
//
// Two activities of a resource are apart modulo the common divisor g of their periods: duration_a <= b - a - g k <= g -
// duration_b for a whole k. So are chains' rests and grids. `kIntegers` has k as a variable (linear integer arithmetic); with
// `kDifferences` each k is a case of its own, so that every constraint bounds a difference of two offsets (QF_IDL, as schedules are
// commonly synthesised): the yardstick. Pairs on a resource enter when an answer breaks them.
//
// Z3's `optimize` is wrong on many such problems in version 4.8.12, so it decides questions alone, and the solver halves ranges.
// It ends by its own count of steps (rlimit), from a fixed seed.
#pragma once

#include <cstdint>

#include "schedules/synthesis/solver/prover.h"

namespace ttf::schedules::synthesis::smt {

enum class Logic { kIntegers, kDifferences };

class Z3Prover final : public solver::Prover {
 public:
  // `steps` limits all of a question's answers together.
  explicit Z3Prover(Logic logic = Logic::kIntegers, std::uint32_t steps = 5'000'000) : logic_(logic), steps_(steps) {}

  // Whether the program was built with Z3 (TTF_WITH_Z3). Without it every answer is kUnknown.
  static bool there();
  solver::Verdict decide(const solver::Question& question, double share, const solver::Repair& repair) override;

 private:
  [[maybe_unused]] Logic logic_;  // a build without Z3 uses neither
  [[maybe_unused]] std::uint32_t steps_;
};

}  // namespace ttf::schedules::synthesis::smt
