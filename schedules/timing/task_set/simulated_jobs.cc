#include "schedules/timing/task_set/simulated_jobs.h"

#include <cstddef>

#include "schedules/timing/chain/timetable.h"
#include "schedules/timing/response/simulation.h"

namespace ttf::schedules::timing::task_set {
namespace {

std::vector<response::PeriodicWork> as_works(std::span<const PeriodicTask> tasks, Duration PeriodicTask::*work) {
  std::vector<response::PeriodicWork> works;
  for (const PeriodicTask& task : tasks)
    works.push_back({.period = task.period.ns, .offset = task.offset.ns, .work = (task.*work).ns});
  return works;
}

}  // namespace

std::optional<SimulatedJobs> simulated_jobs(std::span<const PeriodicTask> by_priority) {
  const auto at_worst = as_works(by_priority, &PeriodicTask::worst);
  // The last ends are less than two hyperperiods later.
  const auto hyperperiod = response::simulated_hyperperiod(at_worst, chain::kLongest.ns / 4, kMostSimulated);
  if (!hyperperiod) return std::nullopt;
  SimulatedJobs found{.hyperperiod = Duration{*hyperperiod}, .jobs = {}};
  for (const PeriodicTask& task : by_priority)
    found.jobs.emplace_back(static_cast<std::size_t>(*hyperperiod / task.period.ns));
  const auto place = [&](const response::EndedJob& job) -> chain::Job& {
    return found.jobs[job.task][static_cast<std::size_t>(job.release / by_priority[job.task].period.ns)];
  };
  response::simulate_jobs(as_works(by_priority, &PeriodicTask::best), *hyperperiod,
                          [&](const response::EndedJob& job) { place(job).reads = Duration{job.start}; });
  response::simulate_jobs(at_worst, *hyperperiod,
                          [&](const response::EndedJob& job) { place(job).writes = Duration{job.end}; });
  return found;
}

}  // namespace ttf::schedules::timing::task_set
