// A stage of a chain of cause and effect: a task or a message, and the instants at which its jobs read and write.
//
//   LET        a job reads at its release and writes at the end of its logical execution time, by default at the next
//              release (Henzinger, Horowitz, Kirsch: "Giotto", Proc. IEEE 91(1), 2003)
//   sampled    implicit communication, as AUTOSAR has it: a job reads as it starts and writes as it ends. Its start is
//              not before its release, and its end not after its response time.
//   activated  the write of the stage before releases a job, which takes that very value: event-driven
// A chain may mix them. Where instants vary, a stage has the earliest reading and the latest writing of each job: they
// make the longest chain, for data goes no slower (schedules/timing/chain/end_to_end.h).
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "core/time.h"

namespace ttf::schedules::timing::chain {

// Instants count from the origin of the stage's cycle.
struct Job {
  Duration reads{};   // at the earliest
  Duration writes{};  // at the latest: the others see the value from then on
};

struct Stage {
  std::string name;
  bool activated = false;
  Duration longest{};  // from the write before to its own; only an activated stage has it
  // Only the others have jobs: those of one cycle, in order. All readings lie within a cycle, and no job writes before
  // an earlier one.
  Duration cycle{};
  std::vector<Job> jobs;
  // Stages of one origin have known phases: their cycles begin together at the origin's zero. None: any phase.
  std::optional<std::size_t> origin;
  // Each job reaches its instants, whatever other jobs and stages do.
  bool exact = false;
  // Whenever a job of this stage starts, no job of the stage before is pending that was released by then: one processor
  // executes both, and the one before has the higher priority and no jitter.
  bool behind_sender = false;
};

// Returns a stage whose jobs read at offset + k * period and write `interval` later: LET, and tasks of a table with a
// known execution time. Without an offset it has any phase. Such a stage is exact.
Stage let_stage(std::string name, Duration period, std::optional<Duration> offset, Duration interval);

// Returns a stage whose jobs are released at offset + k * period and end at most `response` later. It is no exact one.
Stage sampled_stage(std::string name, Duration period, std::optional<Duration> offset, Duration response);

// Returns a stage that writes at most `longest` after the stage before.
Stage activated_stage(std::string name, Duration longest, bool exact);

}  // namespace ttf::schedules::timing::chain
