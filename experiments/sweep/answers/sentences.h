// An experiment's answer in sentences.
#pragma once

#include <string>

#include "experiments/sweep/answers/answer.h"

namespace ttf::experiments::sweep::answers {

// Returns the answer to the file's question, a line each. The interactions come first. Each paradigm, or value of the compared
// axis, has the numbers of points at which the first measure is less, more or undecided. It also has by how much, and where
// that changes for certain.
std::string answer_lines(const SweepFile& sweep, const SweepAnswer& answer);
// Counts the drives in which an object lost its track, and has the answer without such replications. "" without SweepAnswer::lost.
std::string lost_lines(const SweepFile& sweep, const SweepAnswer& answer);
// Says how many comparisons, and how many interactions, stay certain together. Names each pair of paradigms that does.
std::string family_lines(const SweepFile& sweep, const SweepAnswer& answer);

// "camera from 84 ms to 42 ms".
std::string change_name(const SweepFile& sweep, const Interaction& interaction);
// The effect of a change on one paradigm, and the effect of an interaction, with their intervals.
std::string change_effect(const SweepFile& sweep, const Interaction& interaction, const Change& change);
std::string interaction_effect(const SweepFile& sweep, const Interaction& interaction, const InteractionPoint& here);

}  // namespace ttf::experiments::sweep::answers
