// A node's operating system: runs tasks on one processor without preemption.
//
// Tasks activated while the processor is busy wait. A second activation of a waiting task is an overrun. Waiting
// tasks start in order of their activation; at one microtick the task that stands earlier in the file is first.
//
// The processor decides when a task starts and how long it takes. The task's work is done between start_next()
// and finish(). Nothing allocates or throws after construction.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/ids.h"
#include "nodes/host/executive_counts.h"
#include "nodes/host/mode_frames.h"
#include "nodes/host/node_time.h"
#include "recording/records/records.h"
#include "schedules/model/cluster.h"

namespace ttf::nodes::host {

// The key from which execution times are drawn.
struct ExecutionKey {
  std::uint64_t seed = 0;
  std::uint32_t replication = 0;
  NodeId node{};
};

class Processor {
 public:
  // A task's number is its place in `tasks`. All arguments outlive this.
  Processor(const std::vector<schedules::model::Task>& tasks, const ExecutionKey& key, const NodeTime& time,
            ExecutiveCounts& counts);

  // Activates a task. Returns false for an overrun, which is only counted.
  bool activate(std::size_t task, Microticks now);
  void activate_after(std::size_t task, Microticks now);  // activates the tasks that follow the end of `task`
  // Activates the armed tasks that are due.
  void activate_by_time(Microticks now) {
    if (armed_ > 0) activate_armed(now);
  }
  // Arms the tasks that the global time activates in this cycle.
  void arm(std::int64_t cycle);
  void disarm();
  bool waits(std::size_t task) const { return tasks_[task].waiting; }

  // The running task, from its start to its end. The end in `run` is not known yet.
  struct Running {
    std::size_t task = 0;
    std::uint32_t activation = 0;  // how many times the task ran before
    std::optional<ModeTurn> turn;  // if the task has modes
    recording::records::TaskRun run;
  };
  // Starts the first waiting task if the processor is idle; else returns null.
  const Running* start_next(Microticks now);
  // Sets the mode of the frame that the running task begins, at the task's start. It decides how long this execution lasts.
  void choose_mode(std::size_t mode);
  bool ends_by(Microticks now) const { return busy_ && running_end_ <= now; }
  // Ends the running task.
  const Running& finish(Microticks now);

  // Returns the end of the running task, or the next start; kNever: only an activation from outside continues.
  Microticks next_event() const;
  // Returns the shortest execution time of the task.
  Duration shortest(std::size_t task) const;

 private:
  struct State {
    std::vector<std::size_t> successors;  // the tasks that its end activates
    std::uint32_t activations = 0;
    std::optional<ModeFrames> frames;  // if the task has modes
    ModeTurn turn;                     // the waiting activation's
    bool armed = false;                // its activation by time is still due in this cycle
    bool waiting = false;
    Microticks activated{};  // the waiting activation, which may come during the previous execution
    recording::records::Stamp activated_at;
  };
  void activate_armed(Microticks now);
  Duration execution_time(std::size_t task, std::uint32_t activation) const;
  void set_end(Duration lasts);

  const std::vector<schedules::model::Task>& config_;
  const ExecutionKey key_;
  const NodeTime& time_;
  ExecutiveCounts& counts_;
  std::vector<State> tasks_;
  int armed_ = 0;                   // number of armed tasks
  std::vector<std::size_t> ready_;  // waiting tasks, by (activation, place in the file)
  bool busy_ = false;
  Running running_;
  Microticks running_start_{}, running_end_{};
};

}  // namespace ttf::nodes::host
