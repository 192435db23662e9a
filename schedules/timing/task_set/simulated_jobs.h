// Starts and ends of all jobs of a processor with preemptive fixed priorities, where all offsets are known.
//
// The backlog of such a processor repeats from the end of the first hyperperiod on, if the load is at most one and
// offsets are reduced below their periods (J. Leung, M. Merrill, Information Processing Letters 11(3), 1980). No job of
// a preemptive processor starts or ends later if jobs take less time (R. Ha, J. Liu: "Validating timing constraints in
// multiprocessor and distributed real-time systems", ICDCS 1994). So the jobs of the second hyperperiod, simulated with
// best and with worst cases, have the earliest starts and the latest ends.
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
