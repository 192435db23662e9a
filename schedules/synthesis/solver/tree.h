// A search tree over offsets: activities are placed one after another, each at the next offset that nothing placed forbids.
//
// A rule that forbids an offset forbids the interval around it as well, and names the activities that are to blame. So the
// search leaps over intervals, and leaps back to the last activity that is to blame (conflict-directed backjumping: Prosser,
// Computational Intelligence 9(3), 1993). An exhaustive search tries every allowed offset; a coarse one leaps by durations.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "schedules/synthesis/solver/model.h"

namespace ttf::schedules::synthesis::solver {

class Tree {
 public:
  static constexpr std::int64_t kLeapsOfAStep = 16;
  enum class End { kFound, kExhausted, kGaveUp };

  // `seed` draws where the first activity of a chain begins to look; 0: at its window's beginning.
  Tree(const Model& model, std::vector<std::size_t> order, bool exhaustive, std::uint64_t seed = 0);

  // Searches until it has offsets, has tried all, or has gone `most_nodes` steps: a step is an activity placed, or
  // kLeapsOfAStep leaps. Only an exhaustive search ends with kExhausted
  // and a proof.
  End run(std::int64_t most_nodes);

  Solution solution() const { return {offsets_}; }
  std::int64_t nodes() const { return nodes_; }
  // How often each activity found no offset.
  const std::vector<std::int64_t>& dead_ends() const { return dead_ends_; }

 private:
  struct Interval {
    Ticks first, last;
  };
  // The offsets that a level has still to try: two runs, upwards or downwards from a start and then the rest.
  struct Cursor {
    Interval runs[2];
    int run = 0;
    bool upwards = true;
    Ticks next = 0;
  };
  using Blame = std::vector<std::uint64_t>;  // a bit by level

  Cursor cursor_for(std::size_t activity) const;
  bool place_next(std::size_t level);
  void unplace(std::size_t level);
  void place(std::size_t level, Ticks offset);

  // Returns whether `offset` is forbidden, and then the interval; `blame` takes the levels to blame.
  bool forbidden(std::size_t activity, Ticks offset, bool upwards, Interval& interval, Blame& blame) const;
  bool by_resource(std::size_t activity, Ticks offset, bool upwards, Interval& interval, Blame& blame) const;
  bool by_distance(std::size_t activity, Ticks offset, Interval& interval, Blame& blame) const;
  bool by_chain(const Membership& membership, Ticks offset, Interval& interval, Blame& blame) const;
  bool by_sum(std::size_t activity, Ticks offset, Interval& interval, Blame& blame) const;
  bool by_span(std::size_t activity, Ticks offset, Interval& interval, Blame& blame) const;
  Ticks least_age(std::size_t chain) const;
  struct Rest {
    Ticks ticks = 0, modulus = 0;  // modulus 0: nothing is placed there
  };
  Rest rest_beside(const Membership& membership, Ticks offset, bool before) const;
  Interval leap(std::size_t activity, Ticks offset, Ticks excess, std::span<const std::size_t> chains,
                std::span<const Ticks> weights) const;
  void blame_for(std::size_t activity, Blame& blame) const;
  void blame_chain(std::size_t chain, std::size_t but, Blame& blame) const;

  const Model& model_;
  std::vector<std::size_t> order_;
  bool exhaustive_;
  std::uint64_t seed_;
  std::int64_t nodes_ = 0, leaps_ = 0, most_nodes_ = 0;
  std::size_t words_;
  std::vector<std::int64_t> dead_ends_;
  // By activity. offsets_ also holds an offset on trial, of an activity whose level_ is none.
  mutable std::vector<Ticks> offsets_;
  mutable std::vector<std::size_t> level_;
  std::vector<std::vector<std::size_t>> on_resource_;  // activities that are placed
  std::vector<Cursor> cursors_;                        // by level
  std::vector<Blame> blames_;
};

// An order of placing. Chains with a limit come first, each as one, the tightest first; then other activities by period and
// duration. `weights` (by activity; dead ends of earlier searches) draw activities and their chains to the front. Without `by_chain`,
// activities are placed one by one.
std::vector<std::size_t> placing_order(const Model& model, std::span<const std::int64_t> weights, bool by_chain);

}  // namespace ttf::schedules::synthesis::solver
