// Sync frames that were sent and whose confirmation is still to come: what their sender says of them then. Pure; the
// few that an interface may have queued fit, and one that was forgotten for newer ones is told of by no follow-up.
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

  // `last`: the last CAN frame that it was sent in; `due`: when it should have left.
  void expect(const canfd_frame& last, int slot, std::uint8_t cycle_counter, ports::HostTime due);
  bool none() const { return expected_ == 0; }
  // This CAN frame of ours had left at `at`: what is to be told of it, once. Nothing if it is none of the expected
  // ones, or too late to be told (can_be_told()).
  std::optional<FollowUp> left(const canfd_frame& can, ports::HostTime at);

 private:
  struct Departure {
    bool expected = false;
    canfd_frame last{};
    int slot = 0;
    std::uint8_t cycle_counter = 0;
    ports::HostTime due;
  };
  std::array<Departure, kRoom> ring_{};
  std::size_t next_ = 0, expected_ = 0;
};

}  // namespace ttf::bus::socketcan
