#include "experiments/sweep/answers/point_drives.h"

#include <utility>

namespace ttf::experiments::sweep::answers {

PointDrives::PointDrives(const SweepFile& sweep, std::vector<results::Row> rows)
    : rows_(std::move(rows)), first_(sweep.drawn().size()), by_paradigm_(sweep.paradigms.size()) {
  for (const results::Row& row : rows_) {
    if (row.status == results::kDone)
      by_paradigm_[row.key.paradigm].push_back(&row);
    else
      ++failed_;
  }
}

}  // namespace ttf::experiments::sweep::answers
