#include "schedules/synthesis/smt/z3_prover.h"

#include <algorithm>

#include "schedules/synthesis/smt/encoding.h"

namespace ttf::schedules::synthesis::smt {

bool Z3Prover::there() { return true; }

solver::Verdict Z3Prover::decide(const solver::Question& question, double share, const solver::Repair& repair) {
  using Kind = solver::Verdict::Kind;
  const auto most = static_cast<std::uint32_t>(std::min(1.0, share) * steps_);
  std::uint32_t steps = most;
  solver::Verdict verdict;
  try {
    Encoding encoding(question, logic_);
    std::vector<Ticks> offsets;
    while (encoding.whole() && steps > 0) {
      const z3::check_result result = encoding.check(steps, offsets);
      if (result == z3::unsat) verdict.kind = Kind::kInfeasible;
      if (result != z3::sat) break;
      const bool overlaps = encoding.add_overlaps(offsets);
      std::optional<Solution> found = overlaps ? repair({offsets}) : Solution{offsets};
      if (!found) continue;
      verdict = {Kind::kFeasible, std::move(*found), 0};
      break;
    }
  } catch (const z3::exception&) {
    steps = 0;  // out of steps within one of its own procedures: no answer
  }
  verdict.spent = static_cast<double>(most - steps) / steps_;
  return verdict;
}

}  // namespace ttf::schedules::synthesis::smt
