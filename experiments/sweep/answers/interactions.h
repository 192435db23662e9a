// How much more the change of an axis does to one paradigm than to another, from their drives.
#pragma once

#include <vector>

#include "experiments/sweep/answers/answer.h"

namespace ttf::experiments::sweep::answers {

// Answers each interaction of the file, once for all values of the other axes. All of them are one family.
std::vector<InteractionAnswer> interactions_of(const SweepFile& sweep, const results::Store& store);

}  // namespace ttf::experiments::sweep::answers
