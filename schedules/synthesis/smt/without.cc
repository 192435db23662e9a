// The prover in a build without Z3 (TTF_WITH_Z3): it knows no answer.
#include "schedules/synthesis/smt/z3_prover.h"

namespace ttf::schedules::synthesis::smt {

bool Z3Prover::there() { return false; }

solver::Verdict Z3Prover::decide(const solver::Question&, double, const solver::Repair&) { return {}; }

}  // namespace ttf::schedules::synthesis::smt
