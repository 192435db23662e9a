// A node's operating system: who runs when, on one processor without preemption.
//
// Tasks activated while it is busy wait, and an activation that meets a still waiting one of the same task is an
// overrun. Waiting tasks start in order of their activation. Of those activated at one microtick the one that stands
// earlier in the file is first, whatever activated them.
//
// It knows of a task when it may start and how long it takes, not what it does: that happens between start_next() and
// finish(). Nothing allocates or throws after construction.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/ids.h"
#include "nodes/host/executive_counts.h"
#include "nodes/host/node_time.h"
#include "recording/records/records.h"
#include "schedules/model/cluster.h"

namespace ttf::nodes::host {

// What execution times are drawn by.
struct ExecutionKey {
  std::uint64_t seed = 0;
  std::uint32_t replication = 0;
  NodeId node{};
};

class Processor {
 public:
  // Tasks are known by their places in `tasks`. That outlives this, as do the others.
  Processor(const std::vector<schedules::model::Task>& tasks, const ExecutionKey& key, const NodeTime& time,
            ExecutiveCounts& counts);

  // False for an overrun, which changes nothing else.
  bool activate(std::size_t task, Microticks now);
  void activate_after(std::size_t task, Microticks now);  // whatever the end of `task` sets off
  // Whatever is armed and due.
  void activate_by_time(Microticks now) {
    if (armed_ > 0) activate_armed(now);
  }
  // What is to happen by the global time in this cycle.
  void arm(std::int64_t cycle);
  void disarm();
  bool waits(std::size_t task) const { return tasks_[task].waiting; }

  // What runs, from its start to its end; of `run`, the end is not known yet.
  struct Running {
    std::size_t task = 0;
    std::uint32_t activation = 0;  // how many times the task ran before
    recording::records::TaskRun run;
  };
  // The first of the waiting ones starts, if the processor is idle; else null.
  const Running* start_next(Microticks now);
  bool ends_by(Microticks now) const { return busy_ && running_end_ <= now; }
  // What runs is over.
  const Running& finish(Microticks now);

  // The end of what runs, or the next start; kNever: only an activation from outside makes it go on.
  Microticks next_event() const;
  // How long the task takes, at least.
  Duration shortest(std::size_t task) const;

 private:
  struct State {
    std::vector<std::size_t> successors;  // tasks that its end activates
    std::uint32_t activations = 0;
    bool armed = false;  // activation by time, still due in this cycle
    bool waiting = false;
    Microticks activated{};  // of the waiting activation, which may come while the one before still runs
    recording::records::Stamp activated_at;
  };
  void activate_armed(Microticks now);
  Duration execution_time(std::size_t task, std::uint32_t activation) const;

  const std::vector<schedules::model::Task>& config_;
  const ExecutionKey key_;
  const NodeTime& time_;
  ExecutiveCounts& counts_;
  std::vector<State> tasks_;
  int armed_ = 0;                   // of them
  std::vector<std::size_t> ready_;  // waiting tasks, by (activation, place in the file)
  bool busy_ = false;
  Running running_;
  Microticks running_end_{};
};

}  // namespace ttf::nodes::host
