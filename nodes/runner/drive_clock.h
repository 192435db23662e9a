// The time of a drive in real time: how much of the drive has passed at an instant of the machine's clock. With
// a time scale F the drive runs F times slower than that clock. The schedule is stretched and keeps its
// proportions, so the kernel's lateness weighs F times less.
//
// This is the true time in the records of a drive in real time.
#pragma once

#include <cstdint>

#include "bus/ports/live_medium.h"
#include "core/time.h"

namespace ttf::nodes::runner {

class DriveClock {
 public:
  // `origin` is true time 0. `scale_ppm` is a million times F, positive.
  DriveClock(bus::ports::MachineTime origin, std::int64_t scale_ppm);

  TrueTime drive_time(bus::ports::MachineTime at) const;    // rounded down
  bus::ports::MachineTime machine_time(TrueTime at) const;  // the first at which drive_time is at or after it
  Duration in_drive(Duration real) const;                   // rounded down
  Duration in_real(Duration drive) const;                   // rounded up
  bus::ports::MachineTime origin() const { return origin_; }
  // Returns the first instant after `now` that lies a whole number of periods, plus `phase`, after the origin.
  // So periodic work has its place in the drive, whenever a process was started. `period` is positive.
  bus::ports::MachineTime next_turn(Duration period, Duration phase, bus::ports::MachineTime now) const;
  std::int64_t scale_ppm() const { return scale_ppm_; }

 private:
  bus::ports::MachineTime origin_;
  std::int64_t scale_ppm_;
};

}  // namespace ttf::nodes::runner
