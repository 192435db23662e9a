// Why a plan has no solution: statements that cannot hold together, none of them too many, and the changes that help.
//
// The set is found by deletion: a statement without which the others still cannot hold is left out, one after the other. Any
// one of those that remain makes the others possible when it is dropped.
#pragma once

#include <string>
#include <vector>

#include "schedules/synthesis/plan/plan.h"

namespace ttf::schedules::synthesis::explanation {

struct Explanation {
  struct Said {
    std::string file;
    int line = 0;  // 0: said by no line, a default
    std::string text;
  };
  std::vector<Said> core;
  bool proven = true;  // every search behind it was exact, over the lengths and rates that stand for any (explain.cc)
  // The least change of each statement of the core that has a number; one of them is enough.
  std::vector<Said> changes;
};

// Needs a plan without solution. Returns an empty core if no statement helps when it is dropped.
Explanation explain(const plan::Plan& plan);

}  // namespace ttf::schedules::synthesis::explanation
