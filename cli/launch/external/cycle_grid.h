// The cluster's cycles on the machine's clock, as they are received on the bus. Pure: arrivals in, instants out.
//
// A drive that begins with its schedule has its first cycle at a known instant. From then on the cluster's clocks
// count, which run at another rate. Each sync frame of a simulated node says how late it left (its follow-up): less
// that lateness, its arrival is the action point of its slot on the cluster's clock, whatever the kernel did. The
// median over a cycle's sync frames is the begin of that cycle, so a node that is out of step moves nothing. The
// next cycles lie where that begin and the last difference of two begins put them.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "bus/ports/live_medium.h"
#include "core/time.h"
#include "schedules/model/cluster.h"

namespace ttf::cli::launch::external {

class CycleGrid {
 public:
  using MachineTime = bus::ports::MachineTime;

  CycleGrid(const schedules::model::Cluster& cluster, std::int64_t time_scale_ppm);

  // Sets the begin of cycle 0; a cold start has none.
  void begin(MachineTime cycle_0);
  // A simulated node's sync frame arrived in the slot of that cycle count. The last one of a channel and slot awaits its
  // follow-up.
  void sync_frame(schedules::model::Channel channel, int slot, std::uint8_t cycle_counter, MachineTime at);
  void follow_up(schedules::model::Channel channel, int slot, std::uint8_t cycle_counter, Duration late);

  // Returns whether any instant can be placed.
  bool known() const { return reference_.has_value(); }
  // Returns the begin of a cycle, counted from the drive's first. Precondition: known().
  MachineTime start_of(std::int64_t cycle) const;
  // Returns the cycle of an instant, and the cycle nearest to it with that count. Precondition: known().
  std::int64_t cycle_at(MachineTime at) const;
  std::int64_t nearest(MachineTime at, std::uint8_t cycle_counter) const;
  // Returns the last cycle in which the cluster was received, and when; no value before the first.
  std::optional<std::int64_t> last_received_cycle() const { return last_cycle_; }
  std::optional<MachineTime> last_received() const { return last_received_; }
  // Returns the action point of a slot or another macrotick, from the begin of its cycle.
  Duration in_cycle(Macroticks offset) const;
  Macroticks action_point(int slot) const;

 private:
  struct Reference {
    std::int64_t cycle = 0;
    MachineTime start;
  };
  struct Awaited {
    std::optional<std::uint8_t> cycle_counter;
    MachineTime at;
  };
  void take(std::int64_t cycle, MachineTime start);
  void settle();

  const schedules::model::Cluster& cluster_;
  const std::int64_t time_scale_ppm_;
  const Duration nominal_;
  Duration length_;  // the last measured one of a cycle
  std::optional<Reference> reference_;
  bool measured_ = false;  // the reference was received, not given
  std::optional<std::int64_t> last_cycle_;
  std::optional<MachineTime> last_received_;
  std::int64_t collecting_ = 0;  // the cycle whose begins are in starts_
  std::vector<MachineTime> starts_;
  std::array<std::vector<Awaited>, 2> awaited_;  // by channel and slot - 1
};

}  // namespace ttf::cli::launch::external
