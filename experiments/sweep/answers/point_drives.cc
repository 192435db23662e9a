#include "experiments/sweep/answers/point_drives.h"

#include <utility>

#include "evaluation/measures/measure.h"
#include "experiments/results/share.h"

namespace ttf::experiments::sweep::answers {

using evaluation::measures::find_measure;

PointDrives::PointDrives(const SweepFile& sweep, std::vector<results::Row> rows)
    : rows_(std::move(rows)), first_(sweep.drawn().size()), by_paradigm_(sweep.paradigms.size()) {
  for (const results::Row& row : rows_) {
    if (row.status == results::kDone)
      by_paradigm_[row.key.paradigm].push_back(&row);
    else
      ++failed_;
  }
}

results::Interval mean_interval(const SweepFile& sweep, std::size_t measure, const results::Moments& values) {
  return find_measure(sweep.measures[measure])->is_event ? share_of(values, sweep.confidence)
                                                         : interval_of(values, sweep.confidence);
}

results::Interval difference_interval(const SweepFile& sweep, std::size_t measure,
                                      const results::Moments& differences) {
  return find_measure(sweep.measures[measure])->is_event ? difference_of_shares(differences, sweep.confidence)
                                                         : interval_of(differences, sweep.confidence);
}

}  // namespace ttf::experiments::sweep::answers
