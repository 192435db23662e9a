// Bounds of the differences of whole numbers, closed: whatever follows from those that were added is known.
//
// The simple temporal network of Dechter, Meiri and Pearl (Artificial Intelligence 49, 1991). A bound that is added is
// carried through all pairs at once, in at most n^2 steps. Rows that change are kept, so that a search finds its way
// back.
#pragma once

#include <cstddef>
#include <vector>

#include "schedules/synthesis/problem.h"

namespace ttf::schedules::synthesis::solver {

class Differences {
 public:
  // Number 0 is the origin, and 0 by definition. Number n + 1 lies in windows[n].
  explicit Differences(const std::vector<Window>& windows);

  // to - from lies in least..most.
  Ticks most(std::size_t from, std::size_t to) const { return most_[from * count_ + to]; }
  Ticks least(std::size_t from, std::size_t to) const { return -most_[to * count_ + from]; }

  // Adds that to - from is at most (at least) so much. Returns false if nothing keeps all bounds; then the way back is
  // the only way.
  bool add_most(std::size_t from, std::size_t to, Ticks most);
  bool add_least(std::size_t from, std::size_t to, Ticks least) { return add_most(to, from, -least); }
  // How many of the added bounds were news.
  std::size_t changes() const { return changes_; }

  // Marks a place. go_back() leads to the last place that is marked, and takes its mark away.
  void mark();
  void go_back();
  // How many numbers are kept for the ways back.
  std::size_t kept() const { return kept_.size(); }

 private:
  struct Mark {
    std::size_t rows = 0, numbers = 0;
  };
  void keep(std::size_t row);

  std::size_t count_, changes_ = 0;
  std::vector<Ticks> most_;  // by from and to
  std::vector<Mark> marks_;
  std::vector<std::size_t> kept_rows_;
  std::vector<Ticks> kept_;     // by kept row
  std::vector<char> has_kept_;  // by row: whether it is kept since the last mark
};

}  // namespace ttf::schedules::synthesis::solver
