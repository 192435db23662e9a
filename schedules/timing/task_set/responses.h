// Longest responses of a task set, on all its resources at once.
//
// A task that another one activates comes as its activator ends. It has the activator's period, and a jitter from the
// activator's shortest to its longest time from the first release on. Its response grows with its jitter, and so do
// those of others on its resource, which activate further ones. The equations are iterated from no jitter on until
// nothing changes: holistic analysis (K. Tindell, J. Clark, Microprocessing and Microprogramming 40, 1994). It is safe,
// but may find no bound where there is one: mostly where a task activates one of a higher priority on its own
// processor. Jitters that would grow without end are found before, and have no bound. The others are given up
// after 1000 rounds: so near to growth without end, or over a dynamic segment.
//
// Responses and deadlines count from the release before its jitter; that of an activated task is its earliest one.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/time.h"
#include "schedules/timing/response/response.h"
#include "schedules/timing/task_set/task_set.h"

namespace ttf::schedules::timing::task_set {

struct TaskTiming {
  response::Response response;  // from the release before its jitter
  Duration jitter{};            // its own or that of its activation; without a meaning where there is no bound
  // From the first release of its activators, if any, to the end of its shortest and its longest job.
  Duration shortest{}, longest{};
  // On a CAN with errors at random, whose responses are those without errors: at most so likely a frame is not in time.
  std::optional<double> miss_probability;

  bool bounded() const { return response.bounded(); }
};

enum class Assignment : std::uint8_t {
  kGiven,
  kDeadlineMonotonic,
  kAudsley,
  kNone,  // no order meets all deadlines, so far as known; deadline monotonic stands
};

struct ResourceTiming {
  double load = 0;  // sum of worst case / period; on a dynamic segment relative to its share of the cycle
  Assignment assignment{};
  std::vector<std::size_t> by_priority;  // the highest first; of a table: in the file's order
  std::vector<std::size_t> overlap;      // two tasks of a table whose jobs overlap
};

struct Responses {
  std::vector<TaskTiming> tasks;
  std::vector<ResourceTiming> resources;
  int rounds = 0;  // the last iteration took so many
};

// Blank priorities are assigned: deadline monotonic, or else by Audsley's algorithm with the jitters of that order.
Responses responses_of(const TaskSet& set);

// Returns whether the task's deadline, if it has one, is met.
bool keeps_deadline(const TaskSet& set, const Responses& responses, std::size_t task);

// Returns words for people: "as given", "deadline monotonic".
std::string words(Assignment assignment);

}  // namespace ttf::schedules::timing::task_set
