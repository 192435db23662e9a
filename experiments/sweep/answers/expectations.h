// Whether an experiment's expectations hold, from its drives.
#pragma once

#include "experiments/results/store.h"
#include "experiments/sweep/answers/answer.h"

namespace ttf::experiments::sweep::answers {

ExpectationAnswer judge(const SweepFile& sweep, const Expectation& expectation, const results::Store& store);

}  // namespace ttf::experiments::sweep::answers
