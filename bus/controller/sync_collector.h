// What a controller hears of the cluster's sync and startup frames over a double cycle: the deviations that clock
// correction works on, and the startup frames that start-up counts (FlexRay 2.1A, chapters 7.2.4 and 8.5).
#pragma once

#include <array>

#include "bus/poc/event.h"
#include "schedules/model/cluster.h"
#include "timebase/clock_sync.h"

namespace ttf::bus::controller {

class SyncCollector {
 public:
  // sync_node_max: gSyncNodeMax; further sync frames of a cycle are not used.
  explicit SyncCollector(int sync_node_max) : sync_node_max_(sync_node_max) {}

  void reset();  // nothing of the past counts
  void start_cycle(int counter);
  // This node's own sync frame leaves on these channels: it is exactly where it is expected.
  void own(int frame_id, schedules::model::Channels channels);
  // A valid sync frame of another node, on one channel or both; `deviation` [uT], by channel: observed minus expected
  // start. `startup`: it is a startup frame, near enough on one of them to count as one during start-up
  // (pdAcceptedStartupRange).
  void heard(int frame_id, schedules::model::Channels channels, const std::array<int, 2>& deviation, bool startup);

  const timebase::SyncMeasurements& measurements() const { return measurements_; }
  std::span<const timebase::SyncDeviation> odd() const;
  // Sync frames of the cycle so far on one channel, own included, those that are not used too; counts up to 15.
  int valid(schedules::model::Channel channel) const { return valid_[index_of(channel)]; }
  // Startup frames of other nodes, in the cycle that is ending and as pairs of its double cycle.
  poc::StartupFramesSeen startup_frames(int reference) const;

 private:
  struct Ids {
    std::array<int, timebase::kMaxSyncNodes> id{};
    int count = 0;
    bool contains(int frame_id) const;
  };
  void measure(int frame_id, schedules::model::Channels channels, const std::array<int, 2>& deviation);

  int sync_node_max_;
  bool even_ = true;
  timebase::SyncMeasurements measurements_;
  std::array<int, 2> valid_{};  // by channel
  std::array<Ids, 2> startup_;  // of the double cycle's even and odd cycle
};

}  // namespace ttf::bus::controller
