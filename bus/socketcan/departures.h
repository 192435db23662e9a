// Sync frames that await their confirmation, with the data of their follow-ups. Pure. There is room for the
// few that an interface may have queued; a newer frame that overwrites an older one takes its follow-up away.
#pragma once

#include <linux/can.h>

#include <array>
#include <cstddef>
#include <optional>

#include "bus/ports/live_medium.h"
#include "bus/socketcan/flexray_on_can.h"

namespace ttf::bus::socketcan {

class Departures {
 public:
  static constexpr std::size_t kRoom = 16;

  // `last`: the frame's last CAN frame; `due`: the instant at which it should have left.
  void expect(const canfd_frame& last, int slot, std::uint8_t cycle_counter, ports::MachineTime due);
  bool none() const { return expected_ == 0; }
  // Notes that this own CAN frame had left at `at`. Returns the frame's follow-up, once; no value if the frame
  // is not expected or left too late for a follow-up (fits_follow_up()).
  std::optional<FollowUp> left(const canfd_frame& can, ports::MachineTime at);

 private:
  struct Departure {
    bool expected = false;
    canfd_frame last{};
    int slot = 0;
    std::uint8_t cycle_counter = 0;
    ports::MachineTime due;
  };
  std::array<Departure, kRoom> ring_{};
  std::size_t next_ = 0, expected_ = 0;
};

}  // namespace ttf::bus::socketcan
