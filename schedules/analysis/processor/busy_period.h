// How long chains of tasks take at worst on one processor that serves them without preemption, first come first served.
//
// Whatever runs before a job was activated after the last instant at which the processor was idle, and at or before the
// job; so a job activated a after that instant ends at the latest
//   W(a) - a
// after its activation, W(a) being the work activated in a closed window of length a (J. Y. Le Boudec, P. Thiran:
// Network Calculus, Springer 2001, section 1.4: the horizontal distance for a FIFO server of rate one). The bound is
// the largest over all a up to the longest busy time, the smallest A with W(A) <= A. A chain's work comes at its
// beginning at the earliest; so in W it is as much as all its tasks together, whenever its first one is activated:
//
//   by time         the exact instants of a round, at the distances that the clock's corrections can shrink them to
//   by messages     at most floor((a + J) / T) + 1 times in a window, T the shortest time between two lists where they
//   and sensors     are sent and J by how much their way may differ from one to the next; schedules/analysis/
//                   activation_bounds.h has what is known of both
//   by a sensor     that waits for the task's end: the next comes R after that end at the soonest, so the executions
//   that follows    between activations in a window are at most a C / (C + R), and one C more, with C the worst case;
//                   schedules/analysis/sensor_loop.h has R
//
// Durations are nanoseconds of the processor's own clock.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <variant>
#include <vector>

#include "schedules/analysis/processor/activations.h"
#include "schedules/analysis/processor/timed_instants.h"

namespace ttf::schedules::analysis::processor {

inline constexpr std::int64_t kLongestBusy_ns = 20'000'000'000;  // twice the longest deadline a file can ask for

struct ByTime {};  // at its instants in TaskChains::timed

// By a sensor that waits for the end of the chain's first task.
struct ByFollower {
  std::int64_t best = 0, worst = 0;  // that task's execution
  std::int64_t pause = 0;            // from its end to the next activation, at the least; above zero

  std::int64_t shortest_round() const { return best + pause; }
};

struct Chain {
  using Activation = std::variant<ByTime, ActivationBounds, ByFollower>;

  std::int64_t work = 0;  // of all its tasks at worst
  Activation activation;

  bool by_time() const { return std::holds_alternative<ByTime>(activation); }
};

struct TaskChains {
  std::vector<Chain> chains;
  TimedInstants timed;
};

// The longest time that the processor may be busy without a break; nothing if that may be more than `limit`, or if the
// clock cannot be counted on.
std::optional<std::int64_t> busy_time(const TaskChains& set, std::int64_t limit);

// By chain: how long before some activation the newest one of this chain was at the latest. Zero, or no leads at all,
// where nothing is known.
using Leads = std::span<const std::int64_t>;

// From a chain's activation to the end of its work at worst, with the others' leads before it. `busy` is the longest
// busy time.
std::int64_t worst_chain_response(const TaskChains& set, std::size_t chain, std::int64_t busy, Leads leads = {});

}  // namespace ttf::schedules::analysis::processor
