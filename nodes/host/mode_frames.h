// The frames of a task with modes (schedules/model/task_modes.h): which instant is next, and in which cycle.
//
// A frame begins in a cycle of the grid. Without an earlier frame it is the next such cycle; otherwise it is the one in which the
// frame before ends. The step that runs at a frame's first instant may choose the mode of this frame. Otherwise the mode stays.
// So modes change at a frame's end only.
//
// If an instant was missed, because the node had no global time, the next frame begins anew on the grid.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "core/time.h"
#include "schedules/model/cluster.h"

namespace ttf::nodes::host {

// An instant of the task's modes.
struct ModeTurn {
  std::size_t mode = 0;
  std::size_t place = 0;  // among the mode's instants; 0: a frame begins

  bool operator==(const ModeTurn&) const = default;
};

class ModeFrames {
 public:
  // The task outlives this.
  explicit ModeFrames(const schedules::model::Task& task) : task_(&task) {}

  // Returns whether the next instant lies in this cycle. Cycles are asked in their order.
  bool due_in(std::int64_t cycle);
  // Takes the instant that is due.
  ModeTurn take();
  // Chooses the mode of the frame whose first instant was taken last. Returns false, and does nothing, if another one was.
  bool choose(std::size_t mode);
  // Ends the frame, as global time is lost.
  void forget() { begun_.reset(); }

  // Returns the execution time at an instant.
  Duration lasts(const ModeTurn& turn) const { return task_->modes[turn.mode].instants[turn.place].lasts; }
  std::size_t modes() const { return task_->modes.size(); }

 private:
  const schedules::model::TaskMode& mode() const { return task_->modes[mode_]; }

  const schedules::model::Task* task_;
  std::size_t mode_ = 0;
  std::optional<std::int64_t> begun_;  // the frame's first cycle
  std::size_t next_ = 0;               // the place of the next instant; all of the mode's: the next frame's first one
};

}  // namespace ttf::nodes::host
