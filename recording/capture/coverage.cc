#include "recording/capture/coverage.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace ttf::recording::capture {
namespace {

using schedules::model::Channel;
constexpr int kSlots = 2048;  // frame ids are 11 bits

}  // namespace

CaptureCoverage::CaptureCoverage(const schedules::model::Cluster& cluster, schedules::model::Channels channels,
                                 Missing missing)
    : missing_(std::move(missing)), counters_(cluster.flexray.gCycleCountMax + 1),
      owned_(static_cast<std::size_t>(counters_)), packets_(kSlots * 2) {
  for (int counter = 0; counter < counters_; ++counter)
    for (const schedules::model::FrameSlot& frame : cluster.frames)
      for (const Channel channel : schedules::model::kBothChannels)
        if (includes(frame.channels, channel) && includes(channels, channel) &&
            frame.slot <= cluster.flexray.gNumberOfStaticSlots && in_cycle(frame, counter))
          owned_[static_cast<std::size_t>(counter)].push_back({frame.slot, channel});
}

std::uint64_t& CaptureCoverage::packet_of(int slot, Channel channel) {
  return packets_[static_cast<std::size_t>(slot * 2 + static_cast<int>(channel))];
}

bool CaptureCoverage::frame(std::int64_t advance, int counter, int slot, Channel channel, std::uint64_t packet) {
  if (cycle_ < 0) {
    cycle_ = 0;
    after_slot_ = slot;
  } else if (advance > 0) {
    close_cycle(kSlots);
    after_slot_ = 0;
    counter_ = (counter_ + 1) % counters_;
    silent_cycles(advance - 1);
    cycle_ += advance;
    last_before_cycle_ = last_packet_;
    std::fill(packets_.begin(), packets_.end(), 0);
    std::erase_if(damaged_, [this](const Claim& claim) { return claim.cycle < cycle_ - 1; });
  }
  counter_ = counter;
  last_slot_ = slot;
  last_packet_ = packet;
  std::uint64_t& seen = packet_of(slot, channel);
  const bool first = seen == 0;
  if (first) seen = packet;
  return first;
}

void CaptureCoverage::damaged(int counter, int slot, Channel channel) {
  damaged_.push_back({cycle_, counter, {slot, channel}});
}

bool CaptureCoverage::was_damaged(const Owned& owned) const {
  return std::any_of(damaged_.begin(), damaged_.end(), [&](const Claim& claim) {
    return claim.counter == counter_ && claim.place.slot == owned.slot && claim.place.channel == owned.channel;
  });
}

void CaptureCoverage::close_cycle(int before_slot) {
  std::uint64_t after = last_before_cycle_;
  int slot = 0;
  for (const Owned& owned : owned_[static_cast<std::size_t>(counter_)]) {
    for (; slot < owned.slot; ++slot)
      for (const Channel channel : schedules::model::kBothChannels) after = std::max(after, packet_of(slot, channel));
    if (owned.slot <= after_slot_ || owned.slot >= before_slot || packet_of(owned.slot, owned.channel) != 0 ||
        was_damaged(owned))
      continue;
    missing_(after, 1,
             fmt::format("slot {} on {}, cycle {}: has no frame", owned.slot, letter(owned.channel), counter_));
  }
}

// Counts the frames missing in `count` cycles without a frame, from counter_ on.
void CaptureCoverage::silent_cycles(std::int64_t count) {
  if (count == 0) return;
  std::uint64_t all = 0, missing = 0;
  for (int i = 0; i < counters_; ++i) {
    const auto frames = owned_[static_cast<std::size_t>((counter_ + i) % counters_)].size();
    all += frames;
    if (i < count % counters_) missing += frames;
  }
  missing += all * static_cast<std::uint64_t>(count / counters_);
  if (missing > 0)
    missing_(last_packet_, missing,
             fmt::format("cycles from {} on: {} without a single frame, {} frames missing", counter_, count, missing));
}

void CaptureCoverage::finish() {
  if (cycle_ >= 0) close_cycle(last_slot_);
}

}  // namespace ttf::recording::capture
