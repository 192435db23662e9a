// The time of a drive in real time: how much of the drive has passed when the host's clock shows what. With a time
// scale F the drive goes F times slower than the host's clock, so that the schedule is stretched and everything in it
// keeps its proportions; what a kernel is late by is then F times less of it.
//
// What a run's records call true time is this.
#pragma once

#include <cstdint>

#include "bus/ports/live_medium.h"
#include "core/time.h"

namespace ttf::nodes::runner {

class DriveClock {
 public:
  // `origin`: when true time 0 is. `scale_ppm`: a million times F, positive.
  DriveClock(bus::ports::MachineTime origin, std::int64_t scale_ppm);

  TrueTime drive_time(bus::ports::MachineTime at) const;    // rounded down
  bus::ports::MachineTime machine_time(TrueTime at) const;  // the first at which drive_time is at or after it
  Duration in_drive(Duration real) const;                   // rounded down
  Duration in_real(Duration drive) const;                   // rounded up
  bus::ports::MachineTime origin() const { return origin_; }
  // The first instant after `now` that is a whole number of periods, and `phase`, from the origin: what is done
  // periodically is then where it is in the drive, whenever a process was started. `period` positive.
  bus::ports::MachineTime next_turn(Duration period, Duration phase, bus::ports::MachineTime now) const;
  std::int64_t scale_ppm() const { return scale_ppm_; }

 private:
  bus::ports::MachineTime origin_;
  std::int64_t scale_ppm_;
};

}  // namespace ttf::nodes::runner
