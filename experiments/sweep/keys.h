// Checks that no key is set twice.
#pragma once

#include "core/errors.h"
#include "experiments/sweep/file.h"

namespace ttf::experiments::sweep {

// A key set twice has one value of unknown origin. It is a finding if two axes set it, an axis and a paradigm,
// or one setting twice, and one paradigm may have both. A key that an experiment must not vary is a finding,
// too.
void check_keys(const SweepFile& sweep, Findings& findings);

}  // namespace ttf::experiments::sweep
