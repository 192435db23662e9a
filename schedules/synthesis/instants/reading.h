// A plan, with periods chosen, as a problem of offsets (schedules/synthesis/problem.h).
//
//   activities   a scheduled sensor's measurement, a task that time activates, a list's slots; ticks are macroticks
//   resources    the processor of each node and the static segment; real-time media take late frames behind the last slot
//   precedences  from each activity to those that take its data. Behind its end are executions that lists activate,
//                transfers on CANs, and the difference of clocks: the bounds of schedules/analysis, stage by stage, so that
//                what keeps the gaps passes the check
//   chains       those of the plan; an age ends where the last task begins
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "core/ids.h"
#include "schedules/left_out/sources.h"
#include "schedules/synthesis/instants/candidates.h"
#include "schedules/synthesis/plan/plan.h"
#include "schedules/synthesis/problem.h"

namespace ttf::schedules::synthesis::instants {

// The number of the resource that is the static segment; behind it are the processors.
inline constexpr std::size_t kStaticSegment = 0;

// A sensor whose lists a task fuses that time activates.
struct Fused {
  std::size_t measuring = 0, fusing = 0;  // activities
  NodeId node{};
};

struct Reading {
  Problem problem;
  std::vector<std::vector<std::optional<std::size_t>>> tasks;  // activity by node and task
  std::vector<std::optional<std::size_t>> sensors;             // by sensor
  std::vector<std::size_t> lists;                              // by planned list
  std::vector<Fused> fused;                                    // for Plan::in_order; else empty
  Ticks order = 0;                                             // so far apart stamps are certainly in order
};

Reading reading(const plan::Plan& plan, const Timed& timed);

// A candidate with its problem.
struct Read {
  Timed timed;
  Reading reading;
};
// Returns none where the candidate's parameters leave their range (candidates.h).
std::optional<Read> read_of(const plan::Plan& plan, const Candidate& candidate);

// Returns the last slot in use, counted from 1.
Ticks last_slot_of(const Read& read, const Solution& solution);

// Returns a number of slots that no offsets fall below: what stands, and all frames one after another.
Ticks least_slots(const Read& read);

// Returns the share of a round's static frames that are free, on both channels together.
double free_share(const Read& read);

using left_out::ticks;

}  // namespace ttf::schedules::synthesis::instants
