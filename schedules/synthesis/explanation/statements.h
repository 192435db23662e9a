// The statements of a plan, as an explanation names them: the words of each, its line, and the
// plan without it.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "schedules/synthesis/plan/plan.h"

namespace ttf::schedules::synthesis::explanation {

// A number that a statement sets, and in which direction it eases the plan.
struct Dial {
  std::int64_t now = 0, easiest = 0, grain = 1;  // `easiest` may be above or below
  std::function<void(plan::Plan&, std::int64_t)> set;
  std::function<std::string(std::int64_t)> words;  // "chains.laser.largest_age: 54.92 ms"
};

struct Statement {
  std::string text;  // "chains.laser.largest_age: 40 ms"
  int line = 0;      // in the plan's text
  // Lengths of 1 to 16 ms in steps of 0.1 ms (or the plan's, if longer) stand for any cycle, four times a rate for any.
  std::function<void(plan::Plan&)> drop;
  std::optional<Dial> dial;
};

// Returns the statements that bind instants, those first that describe the machine: executions, lists, then slots, rates,
// instants that stand, and ages at last.
std::vector<Statement> statements(const plan::Plan& plan);

}  // namespace ttf::schedules::synthesis::explanation
