// That nobody sets what another sets.
#pragma once

#include "core/errors.h"
#include "experiments/sweep/file.h"

namespace ttf::experiments::sweep {

// A key that two would set has one value, and nobody can tell whose: of two axes, or of an axis and a paradigm, or of
// one setting with itself, those are findings that may meet in one paradigm. So is a key that is not an experiment's to
// vary.
void check_keys(const SweepFile& sweep, Findings& findings);

}  // namespace ttf::experiments::sweep
