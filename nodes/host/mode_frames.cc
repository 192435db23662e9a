#include "nodes/host/mode_frames.h"

namespace ttf::nodes::host {

bool ModeFrames::due_in(std::int64_t cycle) {
  if (begun_) {
    const bool over = next_ == mode().instants.size();
    const std::int64_t at = *begun_ + (over ? mode().cycles : mode().instants[next_].cycle);
    if (cycle <= at) return cycle == at;
  }
  if (!in_cycle(task_->activation.at, cycle)) {
    begun_.reset();
    return false;
  }
  begun_ = cycle;
  next_ = 0;
  return true;
}

ModeTurn ModeFrames::take() {
  if (next_ == mode().instants.size()) {
    *begun_ += mode().cycles;
    next_ = 0;
  }
  return {mode_, next_++};
}

bool ModeFrames::choose(std::size_t mode) {
  if (next_ != 1) return false;
  mode_ = mode;
  return true;
}

}  // namespace ttf::nodes::host
