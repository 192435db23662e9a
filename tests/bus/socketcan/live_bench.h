// Members of one process on separate vcans: the bench for the laws of bus/ports/live_medium.h.
#pragma once

#include <cstring>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "bus/socketcan/medium.h"
#include "tests/bus/socketcan/vcan.h"
#include "tests/laws/live_listener.h"

namespace ttf::bus::socketcan {

// Senders take turns, as in the schedule: the fragments of one frame follow one another.
class InItsSlot final : public ports::LiveMedium {
 public:
  InItsSlot(const LiveOptions& options, std::mutex& slot) : medium_(options), slot_(slot) {}

  ports::LiveStatus send(const ports::LiveSignal& signal, ports::MachineTime due) override {
    const std::scoped_lock lock(slot_);
    return medium_.send(signal, due);
  }
  ports::LiveStatus send_can(std::size_t can_bus, const ports::CanFrame& frame) override {
    return medium_.send_can(can_bus, frame);
  }
  std::optional<ports::LiveArrival> receive() override { return medium_.receive(); }
  int descriptor(ports::Line line) const override { return medium_.descriptor(line); }
  void watch(ports::Line line, bool on) override { medium_.watch(line, on); }
  ports::LiveCounts counts() const override { return medium_.counts(); }
  const std::string& failure() const override { return medium_.failure(); }

 private:
  socketcan::SocketCanMedium medium_;
  std::mutex& slot_;
};

// Two channels, a CAN and a CAN FD. The last of more than two members is not on the first CAN.
template <std::size_t kMembers> class VcanBench : public laws::LiveBench {
 public:
  VcanBench() {
    for (std::size_t i = 0; i < kMembers && missing().empty(); ++i) {
      LiveOptions options{.channels = {vcans_[0], vcans_[1]},
                          .cans = {{on(i, ports::line_of_can(0)) ? vcans_[2] : "", false}, {vcans_[3], true}},
                          .receive_buffer_frames = 2048};
      members_.push_back(std::make_unique<InItsSlot>(options, slot_));
    }
  }
  std::string missing() const override { return vcans_.missing(); }
  std::size_t members() const override { return kMembers; }
  ports::LiveMedium& member(std::size_t index) override { return *members_[index]; }
  std::vector<bool> can_buses() const override { return {false, true}; }
  bool on(std::size_t member, ports::Line line) const override {
    return line != ports::line_of_can(0) || member + 1 < kMembers || kMembers == 2;
  }
  // Foreign: a classic frame on a channel, a 29-bit identifier on a CAN. Malformed: a CAN FD frame of zeros, of a
  // length that only a vcan carries.
  bool intrude(ports::Line line, Intruder what) override {
    Socket stranger({.interface = vcans_[line], .filters = {}});
    canfd_frame can{};
    can.can_id = 5;
    if (what == Intruder::kForeign && line >= ports::line_of_can(0)) can.can_id |= CAN_EFF_FLAG;
    if (what == Intruder::kMalformed) can.flags = CANFD_FDF;
    can.len = what == Intruder::kMalformed ? 13 : 8;
    return stranger.send(can) == Status::kDone;
  }
  std::size_t flood() const override { return 4000; }
  bool loses_pieces() const override { return true; }

 private:
  Vcans vcans_{{"vcan93", "vcan94", "vcan95", "vcan96"}};
  std::mutex slot_;
  std::vector<std::unique_ptr<InItsSlot>> members_;
};

}  // namespace ttf::bus::socketcan
