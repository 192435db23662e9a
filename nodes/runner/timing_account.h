// What a node's process did not do in its time, and what did not come to it in its time: counted, recorded as it
// happens, and its latenesses kept as histograms; what its medium counted is recorded with them. Nothing of it is put
// right.
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
  std::uint64_t late_wakeups = 0;  // something was due for longer than the arrival window allows
  std::uint64_t slots_missed = 0;  // too late for an own slot, by channel: nothing was sent
  std::uint64_t late_frames = 0;   // came behind their window, and were not used
  std::uint64_t early_frames = 0;  // before it
  std::uint64_t frames_lost = 0;   // of others' slots, never came
};

class TimingAccount {
 public:
  // `stamp`: of an instant in the node's microticks.
  TimingAccount(std::function<recording::records::Stamp(ttf::Microticks)> stamp, recording::records::Sink& sink)
      : stamp_(std::move(stamp)), sink_(sink) {}

  void late_wakeup(Microticks due, Duration late);
  void slot_missed(Microticks due, Duration late, std::int64_t cycle, int slot, schedules::model::Channel channel);
  void missed_window(Microticks due, Duration behind, std::int64_t cycle, int slot, schedules::model::Channel channel);
  // `late`: how much later than `noticed` it is.
  void frames_lost(Microticks noticed, Duration late, std::int64_t cycle, int slot, schedules::model::Channel channel,
                   std::uint32_t count);

  recording::records::BinnedDurations wake_ups, departures, arrivals, transits;
  const TimingCounts& counts() const { return counts_; }
  // The histograms and the medium's counts so far; `floor`: of the plain thread; `dropped`: in this process.
  void record(Microticks now, const recording::records::BinnedDurations& floor, const bus::ports::LiveCounts& medium,
              std::uint64_t dropped);

 private:
  std::function<recording::records::Stamp(ttf::Microticks)> stamp_;
  recording::records::Sink& sink_;
  TimingCounts counts_;
};

}  // namespace ttf::nodes::runner
