// The jobs of a periodic stage over all time: job k of cycle c is job c * n + k, for any whole c.
#pragma once

#include <cstdint>
#include <vector>

#include "core/time.h"
#include "schedules/timing/chain/stage.h"

namespace ttf::schedules::timing::chain {

// Longer times and cycles (11 days) are a mistake of the caller: their sums could overflow.
inline constexpr Duration kLongest{1'000'000'000'000'000};

class Timetable {
 public:
  // `stage` must be a sound periodic one. `behind` is the time that activated stages add to a write.
  Timetable(const Stage& stage, Duration behind);

  // Has each job write as it reads.
  void write_at_once();

  Duration cycle() const { return cycle_; }
  std::int64_t jobs_in(Duration cycles) const { return cycles.ns / cycle_.ns * size(); }  // whole cycles
  Duration reads(std::int64_t job) const;
  Duration writes(std::int64_t job) const;  // behind the activated stages
  // Returns the first job that reads at `time` or later: a value written at that instant is seen.
  std::int64_t first_reading_from(Duration time) const;
  // Returns the last job that has written at `time`.
  std::int64_t last_written_by(Duration time) const;

 private:
  std::int64_t size() const { return static_cast<std::int64_t>(jobs_.size()); }

  Duration cycle_;
  std::vector<Job> jobs_;
};

}  // namespace ttf::schedules::timing::chain
