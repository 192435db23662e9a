#include "schedules/timing/chain/timetable.h"

#include <algorithm>
#include <cstddef>

#include "core/check.h"

namespace ttf::schedules::timing::chain {
namespace {

std::int64_t floor_divided(std::int64_t number, std::int64_t by) { return number / by - (number % by < 0 ? 1 : 0); }

void check_sound(const Stage& stage) {
  TTF_CHECK(!stage.activated && !stage.jobs.empty(), "{} has no jobs of its own", stage.name);
  const Job& first = stage.jobs.front();
  const Job& last = stage.jobs.back();
  TTF_CHECK(stage.cycle > Duration{} && stage.cycle <= kLongest, "{}: cycle of {} ns", stage.name, stage.cycle.ns);
  TTF_CHECK(last.reads < first.reads + stage.cycle && last.writes <= first.writes + stage.cycle,
            "{}: its jobs exceed a cycle", stage.name);
  for (std::size_t j = 0; j < stage.jobs.size(); ++j) {
    const Job& job = stage.jobs[j];
    TTF_CHECK(job.reads >= -kLongest && job.reads <= job.writes && job.writes <= kLongest,
              "{}: job {} reads at {} ns and writes at {} ns", stage.name, j, job.reads.ns, job.writes.ns);
    TTF_CHECK(j == 0 || (stage.jobs[j - 1].reads <= job.reads && stage.jobs[j - 1].writes <= job.writes),
              "{}: job {} comes before the one before it", stage.name, j);
  }
}

}  // namespace

Timetable::Timetable(const Stage& stage, Duration behind) : cycle_(stage.cycle), jobs_(stage.jobs) {
  check_sound(stage);
  TTF_CHECK(behind >= Duration{} && behind <= kLongest, "{}: {} ns behind it", stage.name, behind.ns);
  for (Job& job : jobs_) job.writes += behind;
}

void Timetable::write_at_once() {
  for (Job& job : jobs_) job.writes = job.reads;
}

Duration Timetable::reads(std::int64_t job) const {
  const std::int64_t cycle = floor_divided(job, size());
  return jobs_[static_cast<std::size_t>(job - cycle * size())].reads + cycle_ * cycle;
}

Duration Timetable::writes(std::int64_t job) const {
  const std::int64_t cycle = floor_divided(job, size());
  return jobs_[static_cast<std::size_t>(job - cycle * size())].writes + cycle_ * cycle;
}

std::int64_t Timetable::first_reading_from(Duration time) const {
  const std::int64_t cycle = floor_divided((time - jobs_.front().reads).ns, cycle_.ns);
  const auto found = std::ranges::lower_bound(jobs_, time - cycle_ * cycle, {}, &Job::reads);
  return cycle * size() + (found - jobs_.begin());
}

std::int64_t Timetable::last_written_by(Duration time) const {
  const std::int64_t cycle = floor_divided((time - jobs_.front().writes).ns, cycle_.ns);
  const auto found = std::ranges::upper_bound(jobs_, time - cycle_ * cycle, {}, &Job::writes);
  return cycle * size() + (found - jobs_.begin()) - 1;
}

}  // namespace ttf::schedules::timing::chain
