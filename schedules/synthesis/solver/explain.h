// Says why a problem has no solution: statements that cannot hold together, none of them too many, and the smallest change that helps.
#pragma once

#include <compare>
#include <cstddef>
#include <optional>
#include <vector>

#include "schedules/synthesis/problem.h"
#include "schedules/synthesis/solver/solve.h"

namespace ttf::schedules::synthesis::solver {

struct Statement {
  enum class Kind {
    kWindow,
    kPrecedence,
    kResource,
    kAge
  } kind = Kind::kWindow;  // kWindow: window, grid and fixed offset
  std::size_t index = 0;   // the number of the activity, precedence, resource or chain
  auto operator<=>(const Statement&) const = default;
};

struct Explanation {
  std::vector<Statement> core;  // in the problem's order; dropping any one of them makes the rest feasible
  bool smallest = false;        // whether that was shown for every one of them
  // The chain whose largest age alone must grow, and its new value, so that there is a solution: the smallest such growth.
  struct Change {
    std::size_t chain = 0;
    Ticks largest_age = 0;
  };
  std::optional<Change> change;
};

// Needs a problem without mistakes and orders that has no solution. Returns an empty core if that cannot be shown within the effort.
Explanation explain(const Problem& problem, const Effort& effort = {}, Prover* prover = nullptr);

}  // namespace ttf::schedules::synthesis::solver
