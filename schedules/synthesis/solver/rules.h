// A question as rules about differences: each lies in an interval, after some whole turns around a circle.
//
//   resource     duration_a <= b - a - g k <= g - duration_b,                            g = gcd of the periods
//   chain        rest_j = x_j+1 - x_j - ready_j - u_j k,  0 <= rest_j < whole_j,  sum of rests <= limit - base
//   grid         first <= a - P k <= last, and on a step
//   precedence, span           without turns
//
// x_j is the offset of a chain's activity, or a number of its own: the beginning of the instance on the way, modulo the
// stride S_j (model.h). Rests of neighbours add up: between any two places i < j they are x_j - x_i - ready_i..j,
// modulo S_j or, where x_i and x_j are offsets, gcd(T_i, T_j). Limits of sums and orders are left out. Chains whose
// periods do not divide each other have their pairwise bound alone. So the rules forbid nothing that is possible, and
// offsets that they allow are to be checked.
#pragma once

#include <cstddef>
#include <vector>

#include "schedules/synthesis/solver/model.h"

namespace ttf::schedules::synthesis::solver {

// For a whole k: least <= to - from - unit k <= most.
struct Rule {
  std::size_t from = 0, to = 0;  // numbers as in differences.h: 0 is the origin, n + 1 an activity
  Ticks unit = 1, least = 0, most = 0;
};

// The numbers along a chain with a limit.
struct Path {
  std::vector<std::size_t> numbers;  // x
  std::vector<Ticks> ready;          // by place: the sum of ready_j before it
  std::vector<Ticks> units;          // by two places, the earlier first: their rests are known modulo so much
  std::vector<Ticks> whole;          // by link: its rest is less
  std::vector<std::size_t> links;    // rules
  Ticks slack = 0;                   // limit - base
  Ticks unit(std::size_t first, std::size_t last) const { return units[first * numbers.size() + last]; }
};

struct Rules {
  const Model& model;
  std::vector<Window> windows;  // by number but the origin: of activities, then of the instances on paths
  std::vector<Rule> rules;
  std::vector<Path> paths;
  std::vector<std::size_t> on_grid;  // activities whose grid has steps
  bool contradictory = false;        // a rule alone cannot be kept

  // Needs a model that is not contradictory, and that outlives it.
  explicit Rules(const Model& model);

 private:
  void add_places();
  void add_resources();
  void add_path(std::size_t chain);
  void add_spans();
};

}  // namespace ttf::schedules::synthesis::solver
