// The drives of one point, by paradigm, and pairs of drives of the same replication.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "experiments/results/statistics.h"
#include "experiments/results/store.h"
#include "experiments/sweep/file.h"

namespace ttf::experiments::sweep::answers {

class PointDrives {
 public:
  // `rows` are of one point, replication by replication.
  PointDrives(const SweepFile& sweep, std::vector<results::Row> rows);
  PointDrives(PointDrives&&) = default;
  PointDrives& operator=(PointDrives&&) = default;
  PointDrives(const PointDrives&) = delete;
  PointDrives& operator=(const PointDrives&) = delete;

  std::size_t count() const { return rows_.size(); }
  std::size_t failed() const { return failed_; }
  // The drives of a paradigm that did not fail, by replication.
  const std::vector<const results::Row*>& of(std::size_t paradigm) const { return by_paradigm_[paradigm]; }
  // Returns a measure of a drive, by its place in the file's `measures`. Behind them is kTrackLost, unless it is one of them.
  double value(const results::Row& row, std::size_t measure) const { return row.values[first_ + measure]; }

 private:
  std::vector<results::Row> rows_;
  std::size_t failed_ = 0, first_ = 0;
  std::vector<std::vector<const results::Row*>> by_paradigm_;
};

// Drives of the same replication, of two paradigms or at two points: `use(one, other)` gets each pair.
template <class Use>
void for_each_pair(const std::vector<const results::Row*>& ones, const std::vector<const results::Row*>& others,
                   Use use) {
  auto other = others.begin();
  for (const results::Row* one : ones) {
    while (other != others.end() && (*other)->key.replication < one->key.replication) ++other;
    if (other == others.end()) return;
    if ((*other)->key.replication == one->key.replication) use(*one, **other);
  }
}

// Return the interval of a measure's mean, and of its paired differences: those of shares if the measure is an event.
results::Interval mean_interval(const SweepFile& sweep, std::size_t measure, const results::Moments& values);
results::Interval difference_interval(const SweepFile& sweep, std::size_t measure, const results::Moments& differences);

}  // namespace ttf::experiments::sweep::answers
