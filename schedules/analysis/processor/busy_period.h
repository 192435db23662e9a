// Worst-case response times of chains of tasks on one processor, without preemption, first come first served.
//
// All work before a job was activated after the last instant at which the processor was idle, and at or before
// the job. A job activated a after that instant therefore ends at the latest
//   W(a) - a
// after its activation. W(a) is the work activated in a closed window of length a (J. Y. Le Boudec, P. Thiran:
// Network Calculus, Springer 2001, section 1.4: the horizontal distance for a FIFO server of rate one). The
// bound is the largest value over all a up to the longest busy time, the smallest A with W(A) <= A. W counts the
// work of all tasks of a chain at the activation of the first one, which is the earliest:
//
//   by time         the exact instants of a round, at the shortest distances that the clock's corrections allow
//   by messages     at most floor((a + J) / T) + 1 times in a window, T the shortest time between two lists at their
//   and sensors     sender and J the variation of their way; schedules/analysis/activation_bounds.h has the known
//                   pairs
//   by a sensor     that waits for the task's end: the next activation comes at least R after that end, so the
//   that follows    executions between activations in a window are at most a C / (C + R), and one C more, with C the
//                   worst case; schedules/analysis/sensor_loop.h has R
//
// Durations are nanoseconds of the processor's own clock.
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <variant>
#include <vector>

#include "schedules/analysis/processor/activations.h"

namespace ttf::schedules::analysis::processor {

// A clock that follows global time: the most that its corrections can shorten, external terms included.
struct ClockCorrections {
  std::int64_t cycle_ns = 1;
  std::int64_t microticks = 1;  // in a cycle
  std::int64_t rate = 0;        // most microticks taken from a cycle
  std::int64_t offset_ns = 0;   // most time taken from every second cycle

  // Returns the shortest time on this clock for a distance of global time.
  std::int64_t shortest(std::int64_t global_ns) const;
};

// The instants at which time activates a node's chains of tasks, and their distances on the node's own clock.
class TimedInstants {
 public:
  struct Instant {
    std::int64_t at = 0;  // nanoseconds of global time
    std::size_t chain = 0;
    auto operator<=>(const Instant&) const = default;
  };

  // An instant of a chain, at least `distance` from another on the node's clock.
  struct Neighbour {
    std::int64_t distance = 0;
    std::size_t chain = 0;
  };

  enum Direction : bool { kBackward, kForward };

  TimedInstants() = default;
  // Takes the instants of one round; no corrections for a node without global time.
  TimedInstants(std::vector<Instant> instants, std::int64_t round_ns, std::optional<ClockCorrections> corrections);

  bool empty() const { return instants_.empty(); }
  std::size_t size() const { return instants_.size(); }
  std::size_t chain(std::size_t instant) const { return instants_[instant].chain; }

  // Returns false if corrections can shorten a round to less than half: within() might then not end.
  bool can_be_counted_on() const;

  // Returns the shortest time on the node's clock for a distance of global time.
  std::int64_t shortest(std::int64_t global_ns) const;

  // Returns the instants from one instant on, or back from it, that may be at most `most` away, itself included.
  // They are in the order of global time, up to the first that is further away.
  std::vector<Neighbour> within(std::size_t instant, std::int64_t most, Direction direction) const;

 private:
  // Returns an instant by its number, continued beyond the round's last and before its first.
  Instant numbered(std::int64_t number) const;

  std::vector<Instant> instants_;
  std::int64_t round_ns_ = 0;
  std::optional<ClockCorrections> corrections_;
};

inline constexpr std::int64_t kLongestBusy_ns = 20'000'000'000;  // twice the longest deadline that a file allows

struct ByTime {};  // activation at instants of the schedule: TaskChains::timed has them for each chain

// Activation by a sensor that measures after each end of the chain's first task.
struct ByFollower {
  std::int64_t best = 0, worst = 0;  // execution time of that task
  std::int64_t pause = 0;            // least time from its end to its next activation; above zero

  std::int64_t shortest_round() const { return best + pause; }
};

struct Chain {
  using Activation = std::variant<ByTime, ActivationBounds, ByFollower>;

  std::int64_t work = 0;  // worst case of all its tasks
  Activation activation;

  bool by_time() const { return std::holds_alternative<ByTime>(activation); }
};

struct TaskChains {
  std::vector<Chain> chains;
  TimedInstants timed;
};

// Returns the longest time that the processor may be busy without a break. Returns nullopt if that may exceed
// `limit`, or if the clock's corrections leave no bound.
std::optional<std::int64_t> busy_time(const TaskChains& set, std::int64_t limit);

// Each chain has a lead: its newest activation is at least this long before a given instant. An unknown lead is zero;
// without leads, all are unknown.
using Leads = std::span<const std::int64_t>;

// Returns the longest time from a chain's activation to the end of its work, given the others' leads before it.
// `busy` is the longest busy time.
std::int64_t worst_chain_response(const TaskChains& set, std::size_t chain, std::int64_t busy, Leads leads = {});

}  // namespace ttf::schedules::analysis::processor
