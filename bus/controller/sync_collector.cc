#include "bus/controller/sync_collector.h"

#include <algorithm>

namespace ttf::bus::controller {

void SyncCollector::reset() {
  measurements_.even_count = measurements_.odd_count = 0;
  startup_ = {};
}

void SyncCollector::start_cycle(int counter) {
  even_ = counter % 2 == 0;
  if (even_) reset();
  // An odd cycle that a node enters in the middle has no even partner: reset() has emptied the even list.
  (even_ ? measurements_.even_count : measurements_.odd_count) = 0;
  startup_[even_ ? 0 : 1] = {};
  valid_ = {};
}

void SyncCollector::measure(int frame_id, schedules::model::Channels channels, const std::array<int, 2>& deviation) {
  for (const schedules::model::Channel channel : schedules::model::kBothChannels) {
    int& valid = valid_[index_of(channel)];
    valid = std::min(valid + (includes(channels, channel) ? 1 : 0), timebase::kMaxSyncNodes);
  }
  auto& list = even_ ? measurements_.even : measurements_.odd;
  int& count = even_ ? measurements_.even_count : measurements_.odd_count;
  // Searches from the end: the other channel's frame of the same slot comes next, unless both came at once.
  int index = count - 1;
  while (index >= 0 && list[static_cast<std::size_t>(index)].frame_id != frame_id) --index;
  if (index < 0) {
    if (count == std::min(sync_node_max_, timebase::kMaxSyncNodes)) return;
    index = count++;
    list[static_cast<std::size_t>(index)] = {frame_id, std::nullopt, std::nullopt};
  }
  timebase::SyncDeviation& entry = list[static_cast<std::size_t>(index)];
  if (includes(channels, schedules::model::Channel::kA)) entry.a = deviation[0];
  if (includes(channels, schedules::model::Channel::kB)) entry.b = deviation[1];
}

void SyncCollector::own(int frame_id, schedules::model::Channels channels) { measure(frame_id, channels, {}); }

void SyncCollector::received(int frame_id, schedules::model::Channels channels, const std::array<int, 2>& deviation,
                             bool startup) {
  measure(frame_id, channels, deviation);
  Ids& ids = startup_[even_ ? 0 : 1];
  if (!startup || ids.count == timebase::kMaxSyncNodes || ids.contains(frame_id)) return;
  ids.id[static_cast<std::size_t>(ids.count++)] = frame_id;
}

std::span<const timebase::SyncDeviation> SyncCollector::odd() const {
  return {measurements_.odd.data(), static_cast<std::size_t>(measurements_.odd_count)};
}

bool SyncCollector::Ids::contains(int frame_id) const {
  return std::find(id.begin(), id.begin() + count, frame_id) != id.begin() + count;
}

poc::StartupFramesSeen SyncCollector::startup_frames(int reference) const {
  const Ids& now = startup_[even_ ? 0 : 1];
  poc::StartupFramesSeen seen;
  seen.frames = now.count;
  seen.reference_frame = now.contains(reference);
  if (even_) return seen;
  for (int i = 0; i < now.count; ++i)
    if (startup_[0].contains(now.id[static_cast<std::size_t>(i)])) ++seen.pairs;
  seen.reference_pair = seen.reference_frame && startup_[0].contains(reference);
  return seen;
}

}  // namespace ttf::bus::controller
