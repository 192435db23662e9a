// Tracks which owned slots of a capture's cycles have a frame. Private to the module.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "schedules/model/cluster.h"

namespace ttf::recording::capture {

class CaptureCoverage {
 public:
  // `count` frames are missing after a packet.
  using Missing = std::function<void(std::uint64_t packet, std::uint64_t count, std::string text)>;
  CaptureCoverage(const schedules::model::Cluster& cluster, schedules::model::Channels channels, Missing missing);

  // Takes the next frame, sent `advance` cycles after the previous one, in a cycle with this counter. Returns
  // whether it is the first frame of its slot and channel in that cycle.
  bool frame(std::int64_t advance, int counter, int slot, schedules::model::Channel channel, std::uint64_t packet);
  // Takes a frame that claims this place, but whose header fails its CRC: it is damaged, not missing.
  void damaged(int counter, int slot, schedules::model::Channel channel);
  // Call it after the last frame.
  void finish();
  std::int64_t cycles() const { return cycle_ + 1; }

 private:
  struct Owned {
    int slot = 0;
    schedules::model::Channel channel{};
  };
  struct Claim {
    std::int64_t cycle = 0;  // the running cycle at its arrival
    int counter = 0;
    Owned place;
  };
  std::uint64_t& packet_of(int slot, schedules::model::Channel channel);
  bool was_damaged(const Owned& owned) const;
  void close_cycle(int before_slot);
  void silent_cycles(std::int64_t count);

  Missing missing_;
  int counters_;
  std::vector<std::vector<Owned>> owned_;  // by cycle counter, in the order of slots
  std::vector<std::uint64_t> packets_;     // in the current cycle, by slot and channel; 0: no packet
  std::vector<Claim> damaged_;
  std::int64_t cycle_ = -1;  // running, from 0
  int counter_ = 0;
  int after_slot_ = 0;  // the first cycle's coverage begins after this slot
  int last_slot_ = 0;
  std::uint64_t last_packet_ = 0, last_before_cycle_ = 0;
};

}  // namespace ttf::recording::capture
