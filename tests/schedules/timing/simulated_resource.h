// A processor or a bus that serves jobs by priority, event by event: an oracle for analyses. It uses no theory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace ttf::schedules::timing {

struct SimulatedJob {
  std::size_t task = 0;       // its priority: 0 is the highest
  std::int64_t arrival = 0;   // its response counts from here
  std::int64_t released = 0;  // it waits from here on
  std::int64_t work = 0;
};

enum class Preemption : bool { kNever, kAlways };

// Returns the end of each job, in the order of `jobs`. The resource is busy with something else until `begin`. A job
// that comes at an instant of choice takes part in it.
std::vector<std::int64_t> simulated_ends(const std::vector<SimulatedJob>& jobs, Preemption preemption,
                                         std::int64_t begin = 0);

// Returns the longest response of each task, arrival to end.
std::vector<std::int64_t> simulated_longest(const std::vector<SimulatedJob>& jobs, std::size_t tasks,
                                            Preemption preemption, std::int64_t begin = 0);

}  // namespace ttf::schedules::timing
