// Finds offsets: the best by objectives in lexicographic order, with a bound that says how much better any offsets could be.
//
// Ways, cheapest first: constructive placement with local search; bounds from relaxations (a chain among what is fixed, alone
// and in company); exhaustion; and a prover over integers, if one is given (smt/). A search ends by a count of steps, never by
// a clock, and draws from fixed seeds: the same problem has the same answer. Every solution passes the checker.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "schedules/synthesis/problem.h"
#include "schedules/synthesis/solver/prover.h"

namespace ttf::schedules::synthesis::solver {

// A value that is to be least.
struct Objective {
  enum class Kind {
    kLargestAge,  // the largest of weight * age over chains
    kSumOfAges,   // the sum of weight * age over chains
    kLateness,    // the largest of age - largest age over chains that have one: less is more slack
    kSpan,        // the last end less the first beginning, of activities
    kFunction,    // a function of the offsets
  };
  Kind kind = Kind::kLargestAge;
  std::vector<std::size_t> which;  // chains, of kSpan activities; none: all
  std::vector<Ticks> weights;      // > 0, by `which` (by chain if it is empty); none: 1
  // kFunction: a pure function of the offsets by activity. It depends on `moving` activities alone (none: on all), and on their
  // offsets modulo their periods. The solver tries their offsets on a raster of `raster` ticks, counted from a window's first.
  // Objectives behind it leave them where they are.
  std::function<double(std::span<const Ticks>)> function;
  std::vector<std::size_t> moving;
  Ticks raster = 1;
};

struct Effort {
  std::int64_t steps = 100'000;       // of placement and local search; a step is an activity tried
  std::int64_t exhaustion = 100'000;  // nodes of a tree that may be searched through, for each question
  int seeds = 4;                      // restarts of local search
  double proofs = 2;                  // shares of the prover's steps that all questions of an objective may take
};

// How well an objective was met. Values are whole ticks, except of kFunction.
struct Reached {
  // No offsets that keep the earlier objectives' values (of kFunction: the offsets that it chose) are better than the bound.
  double value = 0, bound = 0;
  bool proven = false;  // value == bound; of kFunction: no offsets on the raster are better
  std::string way;      // "placement meets the bound", "exhausted", "integers", "not proven"
};

struct Outcome {
  std::optional<Solution> solution;
  bool proven_infeasible = false;  // if there is no solution: whether there is none, or the search gave up
  std::string way;                 // if it is proven: "windows and precedences", "exhausted", "integers"
  std::vector<Reached> reached;    // by objective; empty without a solution
};

// Needs a problem without mistakes (checker.h). `prover` may be null.
Outcome solve(const Problem& problem, std::span<const Objective> objectives, const Effort& effort = {},
              Prover* prover = nullptr);

}  // namespace ttf::schedules::synthesis::solver
