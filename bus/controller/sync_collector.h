// The sync collector gathers the cluster's sync and startup frames over a double cycle (FlexRay 2.1A, chapters
// 7.2.4 and 8.5). It has the deviations for clock correction, and the startup frames for start-up.
#pragma once

#include <array>

#include "bus/poc/event.h"
#include "schedules/model/cluster.h"
#include "timebase/clock_sync.h"

namespace ttf::bus::controller {

class SyncCollector {
 public:
  // sync_node_max: gSyncNodeMax; further sync frames of a cycle are ignored.
  explicit SyncCollector(int sync_node_max) : sync_node_max_(sync_node_max) {}

  void reset();  // forgets all frames
  void start_cycle(int counter);
  // Notes that this node's own sync frame leaves on these channels; its deviation is zero.
  void own(int frame_id, schedules::model::Channels channels);
  // Notes a valid sync frame of another node, on one channel or both; `deviation` [uT], by channel: observed
  // minus expected start. `startup`: a startup frame within pdAcceptedStartupRange on at least one channel.
  void received(int frame_id, schedules::model::Channels channels, const std::array<int, 2>& deviation, bool startup);

  const timebase::SyncMeasurements& measurements() const { return measurements_; }
  std::span<const timebase::SyncDeviation> odd() const;
  // Sync frames of the cycle so far on one channel, up to 15; includes the own one and those beyond gSyncNodeMax.
  int valid(schedules::model::Channel channel) const { return valid_[index_of(channel)]; }
  // Counts other nodes' startup frames in the ending cycle, and their pairs in its double cycle.
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
  std::array<Ids, 2> startup_;  // the double cycle's even and odd cycle
};

}  // namespace ttf::bus::controller
