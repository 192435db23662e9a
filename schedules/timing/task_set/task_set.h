// A set of bare tasks and messages, without a cluster: what theory needs for responses and chains.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/time.h"

namespace ttf::schedules::timing::task_set {

enum class Policy : std::uint8_t {
  kPreemptive,     // fixed priorities; a job makes way for one of a higher priority
  kNonPreemptive,  // fixed priorities; a job that has begun ends first
  kCan,            // a CAN with identifiers of 11 bits: the lowest one first
  kCanExtended,    // ... of 29 bits
  kDynamic,        // FlexRay's dynamic segment: the slot of the lowest number first, in each cycle anew
  kTdma,           // each task has a slot of its own in every cycle, which interrupts it at its end
  kTable,          // time-triggered: each job begins at its offset, and has the resource alone
};

// A processor, or a bus.
struct Resource {
  std::string name;
  bool is_bus = false;
  Policy policy{};
  std::int64_t bit_rate = 0;  // of a CAN
  // Errors on a CAN: at least so long apart, or at random at this rate; 0: none of these.
  std::optional<Duration> errors_apart;
  double errors_per_s = 0;
  Duration cycle{};  // TDMA and dynamic segment
  // Dynamic segment. Its controllers decide at the segment's start what they send, or else at each turn.
  std::int64_t minislots = 0;
  Duration minislot{};
  bool decides_at_start = false;
  // Offsets on resources of one clock have the same zero. Those of different clocks have any phase.
  std::string clock;

  bool is_can() const { return policy == Policy::kCan || policy == Policy::kCanExtended; }
  // Whether tasks are assigned priorities where the file gives none.
  bool has_priorities() const { return policy != Policy::kTable && policy != Policy::kTdma; }
};

enum class Communication : std::uint8_t {
  kImplicit,  // a task reads as it starts and writes as it ends; a message takes its value as it is queued
  kLet,       // reads at its release and writes at its deadline
  kEvent,     // the stage before it in its chains releases it; without one, events from outside do
};

// A task on a processor, or a message on a bus.
struct Task {
  std::string name;
  bool is_message = false;
  std::size_t resource = 0;
  // An activated task has none. For events from outside it is the least time between two.
  std::optional<Duration> period;
  std::optional<Duration> offset;  // none: any phase
  Duration jitter{};               // a release is late by so much at most
  // The resource is taken for so long. A frame has no stuff bits at best, and the most at worst.
  Duration best{}, worst{};
  std::optional<Duration> deadline;      // from the release before its jitter; none for activated ones that have none
  std::optional<std::int64_t> priority;  // the smallest first; the number of a dynamic slot
  Communication communication{};
  std::optional<std::size_t> activator;  // the task whose end releases this one
  Duration slot{};                       // TDMA: the length of its slot
  // Dynamic segment: the length of its frame, its cycles, and pLatestTx of its sender.
  std::int64_t minislots = 0, latest_tx = 0;
  int base_cycle = 0, repetition = 1;

  bool is_event() const { return communication == Communication::kEvent; }
};

struct Chain {
  std::string name;
  std::vector<std::size_t> stages;  // tasks and messages, in the order of the data
  std::optional<Duration> largest_age;
};

// Names are unique: of resources, of tasks and messages, of chains. All tasks of a resource have a priority, or none.
struct TaskSet {
  std::string name;  // the file's, without folder and end
  std::vector<Resource> resources;
  std::vector<Task> tasks;
  std::vector<Chain> chains;

  std::vector<std::size_t> tasks_on(std::size_t resource) const;  // in the file's order
  Duration period_of(std::size_t task) const;                     // an activated task has that of its first activator
};

// Returns "preemptive", "non_preemptive", "can", "can_extended", "dynamic", "tdma" or "table": the word of the file.
const char* word(Policy policy);
const char* word(Communication communication);  // "implicit", "let" or "event"

}  // namespace ttf::schedules::timing::task_set
