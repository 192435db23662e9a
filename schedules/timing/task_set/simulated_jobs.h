// The earliest start and the latest end of all jobs of a processor with preemptive fixed priorities, where all offsets
// are known: the jobs of a hyperperiod, simulated with best and with worst cases (schedules/timing/response/simulation.h).
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/time.h"
#include "schedules/timing/chain/stage.h"

namespace ttf::schedules::timing::task_set {

struct PeriodicTask {
  Duration period{}, offset{};
  Duration best{}, worst{};
};

struct SimulatedJobs {
  Duration hyperperiod{};
  std::vector<std::vector<chain::Job>> jobs;  // for each task those of one hyperperiod
};

inline constexpr std::int64_t kMostSimulated = 400'000;  // jobs in two hyperperiods

// Takes the tasks by priority, the highest first. Returns none if the load exceeds one, the jobs exceed kMostSimulated
// or the hyperperiod exceeds a quarter of chain::kLongest.
std::optional<SimulatedJobs> simulated_jobs(std::span<const PeriodicTask> by_priority);

}  // namespace ttf::schedules::timing::task_set
