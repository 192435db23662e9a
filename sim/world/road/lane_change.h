// The way from one lane to another: sideways by half a wave of a cosine over a given time, as esmini's sinusoidal lane change.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/time.h"

namespace ttf::sim::world::road {

class LaneChange {
 public:
  explicit LaneChange(double offset) : from_(offset), to_(offset) {}

  // Begins where the offset is now, without a sideways speed.
  void begin(double to, Duration within) {
    from_ = offset();
    to_ = to;
    seconds_ = within.seconds();
    progress_ = 0.0;
  }
  // `seconds` counts the change's own time: less than the world's where it is to be slower.
  void advance(double seconds) { progress_ = std::min(1.0, progress_ + seconds / seconds_); }

  double offset() const { return from_ + (to_ - from_) * 0.5 * (1.0 - std::cos(std::numbers::pi * progress_)); }
  // The offset's first and second time derivative.
  double rate() const { return (to_ - from_) * 0.5 * pace() * std::sin(std::numbers::pi * progress_); }
  double second() const {
    return over() ? 0.0 : (to_ - from_) * 0.5 * pace() * pace() * std::cos(std::numbers::pi * progress_);
  }

 private:
  bool over() const { return progress_ >= 1.0; }
  double pace() const { return over() ? 0.0 : std::numbers::pi / seconds_; }

  double from_, to_;  // [m]
  double seconds_ = 1.0, progress_ = 1.0;
};

}  // namespace ttf::sim::world::road
