// Counts and records everything that a node's process did or received too late. Keeps latenesses as histograms,
// and records the medium's counts with them. It corrects nothing.
#pragma once

#include <cstdint>
#include <functional>

#include "bus/ports/live_medium.h"
#include "core/time.h"
#include "recording/records/binned_durations.h"
#include "recording/records/records.h"
#include "schedules/model/cluster.h"

namespace ttf::nodes::runner {

struct TimingCounts {
  std::uint64_t late_wakeups = 0;  // wake-ups later than the arrival window allows
  std::uint64_t slots_missed = 0;  // too late for an own slot, by channel: nothing was sent
  std::uint64_t late_frames = 0;   // came after their window, not used
  std::uint64_t early_frames = 0;  // came before their window, not used
  std::uint64_t frames_lost = 0;   // frames of other nodes' slots that never came
};

class TimingAccount {
 public:
  // `stamp` makes the stamp of an instant in the node's microticks.
  TimingAccount(std::function<recording::records::Stamp(ttf::Microticks)> stamp, recording::records::Sink& sink)
      : stamp_(std::move(stamp)), sink_(sink) {}

  void late_wakeup(Microticks due, Duration late);
  void slot_missed(Microticks due, Duration late, std::int64_t cycle, int slot, schedules::model::Channel channel);
  void missed_window(Microticks due, Duration behind, std::int64_t cycle, int slot, schedules::model::Channel channel);
  // `late`: the time since `noticed`.
  void frames_lost(Microticks noticed, Duration late, std::int64_t cycle, int slot, schedules::model::Channel channel,
                   std::uint32_t count);

  recording::records::BinnedDurations wake_ups, departures, arrivals, transits;
  const TimingCounts& counts() const { return counts_; }
  // Records the histograms and the medium's counts so far. `floor` is the plain thread's, `dropped` this process's.
  void record(Microticks now, const recording::records::BinnedDurations& floor, const bus::ports::LiveCounts& medium,
              std::uint64_t dropped);

 private:
  std::function<recording::records::Stamp(ttf::Microticks)> stamp_;
  recording::records::Sink& sink_;
  TimingCounts counts_;
};

}  // namespace ttf::nodes::runner
