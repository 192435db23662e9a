// A search over whole turns: how often each rule (rules.h) goes around its circle, and where on its grid an activity
// lies.
//
// Offsets stay open: the search keeps all differences that the turns chosen so far allow (differences.h). A rule with
// one turn left binds. The rests of a chain limit each other: what the others need at least is no longer there for one.
// So a branch ends as soon as its turns contradict each other, and a branch with all turns chosen has offsets. The rule
// with the fewest turns left, of those that failed most, is split next (dom/wdeg: Boussemart, Hemery, Lecoutre, Sais,
// ECAI 2004). The search begins anew now and then, and remembers the failures.
#pragma once

#include <cstdint>
#include <vector>

#include "schedules/synthesis/solver/differences.h"
#include "schedules/synthesis/solver/rules.h"

namespace ttf::schedules::synthesis::solver {

class Turns {
 public:
  enum class End { kFound, kExhausted, kGaveUp };
  // More numbers than these take too long.
  static constexpr std::size_t kMostNumbers = 400;

  // `rules` outlive it.
  explicit Turns(const Rules& rules);

  // Searches until it has offsets, has tried all turns, or has made so many splits. It begins anew after ever more of
  // them. Only kExhausted is a proof.
  End run(std::int64_t most_splits);

  // Returns the offsets found, by activity: they keep the rules.
  const std::vector<Ticks>& found() const { return found_; }
  std::int64_t splits() const { return splits_; }

 private:
  // A rule, or a grid behind the rules, that has a choice: a difference of at most `most`, or of at least `least`.
  struct Split {
    std::size_t rule = 0, from = 0, to = 0;
    Ticks most = 0, least = 0;
    bool lower_first = true;
  };
  struct Range {
    Ticks first = 0, last = 0;
  };

  End descend(std::int64_t most_splits, std::uint64_t number);
  bool choose(Split& split) const;
  bool apply(const Split& split, bool lower);
  bool propagate();
  bool round_to_grids();
  bool bind(const Rule& rule);
  bool limit_rests(const Path& path);
  Range turns(const Rule& rule) const;
  Ticks least_rest(const Path& path, std::size_t first, std::size_t last) const;
  bool fails(std::size_t rule);

  const Rules& rules_;
  Differences differences_;
  bool sound_ = true;                  // before any choice
  std::vector<std::int64_t> weights_;  // by rule, then by grid: how often it failed
  std::vector<Split> path_;            // the splits that led here
  std::int64_t splits_ = 0;
  std::vector<Ticks> found_;
};

}  // namespace ttf::schedules::synthesis::solver
