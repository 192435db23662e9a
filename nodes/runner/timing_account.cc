#include "nodes/runner/timing_account.h"

namespace ttf::nodes::runner {

using recording::records::LatenessOf;
using recording::records::TimingFault;

void TimingAccount::late_wakeup(Microticks due, Duration late) {
  ++counts_.late_wakeups;
  sink_.on(recording::records::TimingProblem{stamp_(due), TimingFault::kLateWakeUp, late});
}

void TimingAccount::slot_missed(Microticks due, Duration late, std::int64_t cycle, int slot,
                                schedules::model::Channel channel) {
  ++counts_.slots_missed;
  sink_.on(recording::records::TimingProblem{stamp_(due), TimingFault::kSlotMissed, late, cycle,
                                             static_cast<std::uint16_t>(slot), static_cast<std::uint8_t>(channel)});
}

void TimingAccount::missed_window(Microticks due, Duration behind, std::int64_t cycle, int slot,
                                  schedules::model::Channel channel) {
  const bool late = behind > Duration{};
  ++(late ? counts_.late_frames : counts_.early_frames);
  sink_.on(recording::records::TimingProblem{stamp_(due), late ? TimingFault::kLateFrame : TimingFault::kEarlyFrame,
                                             behind, cycle, static_cast<std::uint16_t>(slot),
                                             static_cast<std::uint8_t>(channel)});
}

void TimingAccount::frames_lost(Microticks noticed, Duration late, std::int64_t cycle, int slot,
                                schedules::model::Channel channel, std::uint32_t count) {
  counts_.frames_lost += count;
  sink_.on(recording::records::TimingProblem{stamp_(noticed), TimingFault::kFramesLost, late, cycle,
                                             static_cast<std::uint16_t>(slot), static_cast<std::uint8_t>(channel),
                                             count});
}

void TimingAccount::record(Microticks now, const recording::records::BinnedDurations& floor,
                           const bus::ports::LiveCounts& medium, std::uint64_t dropped) {
  const recording::records::Stamp at = stamp_(now);
  const auto report = [&](LatenessOf of, const recording::records::BinnedDurations& lateness) {
    sink_.on(recording::records::LatenessHistogram{at, of, lateness.longest(), lateness.counts()});
  };
  report(LatenessOf::kWakeUps, wake_ups);
  report(LatenessOf::kFloor, floor);
  report(LatenessOf::kDepartures, departures);
  report(LatenessOf::kArrivals, arrivals);
  report(LatenessOf::kTransits, transits);
  sink_.on(recording::records::MediumCounts{at, medium.sent, medium.received, medium.not_sent, medium.lost,
                                            medium.foreign, medium.malformed, dropped});
}

}  // namespace ttf::nodes::runner
