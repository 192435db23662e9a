// How early before the use a best placement may have an activity: a bound by the others in its way, beside the bound by ages.
//
// A short chain's age allows its list nearly a period more than that of a long one, although the list needs no such rest. A later
// beginning makes no age larger, so some best placement has each activity as late as the others let it:
//
//   lists      may change places. Others block so many of the places that a list may take, and the next one is free.
//   fusions    keep their order, for the sake of the measurements' order. They move up to one another and to the task behind
//              them. Nothing else may be on their processor.
//
// This holds where each activity on the way to the anchor has one taker there: a later beginning of data then is late for none.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <vector>

#include "schedules/synthesis/instants/graph.h"
#include "schedules/synthesis/instants/reading.h"

namespace ttf::schedules::synthesis::instants {

class Reach {
 public:
  // `grids` and `main` by activity: the places within the limits, and whether a way leads to the anchor. References are kept.
  Reach(const Reading& reading, const Graph& graph, const std::vector<Grid>& grids, const std::vector<bool>& main,
        std::size_t anchor);

  // Returns how long before the anchor the activity begins in some best placement, at most. `by_age` has the same by ages,
  // for each activity (none: no age says so).
  std::optional<Ticks> earliest(std::size_t a, const std::vector<std::optional<Ticks>>& by_age);

 private:
  // Returns how much earlier than it must the activity may begin, so that nothing later is free.
  std::optional<Ticks> held_up(std::size_t a) const;
  std::optional<Ticks> among_fusions(std::size_t a) const;
  std::optional<Ticks> among_places(std::size_t a) const;
  bool fuses(std::size_t a) const;
  bool takes(std::size_t taker, std::size_t from) const;

  const Reading& reading_;
  const Graph& graph_;
  const std::vector<Grid>& grids_;
  const std::vector<bool>& main_;
  std::size_t anchor_;
  std::map<std::size_t, std::optional<Ticks>> known_;
};

}  // namespace ttf::schedules::synthesis::instants
