#include "nodes/runner/timing_account.h"

namespace ttf::runner {

void TimingAccount::late_wakeup(Microticks due, Duration late) {
  ++counts_.late_wakeups;
  sink_.on(records::TimingProblem{stamp_(due), records::kLateWakeUp, late});
}

void TimingAccount::slot_missed(Microticks due, Duration late, std::int64_t cycle, int slot,
                                schedules::Channel channel) {
  ++counts_.slots_missed;
  sink_.on(records::TimingProblem{stamp_(due), records::kSlotMissed, late, cycle, static_cast<std::uint16_t>(slot),
                                  static_cast<std::uint8_t>(channel)});
}

void TimingAccount::missed_window(Microticks due, Duration behind, std::int64_t cycle, int slot,
                                  schedules::Channel channel) {
  const bool late = behind > Duration{};
  ++(late ? counts_.late_frames : counts_.early_frames);
  sink_.on(records::TimingProblem{stamp_(due), late ? records::kLateFrame : records::kEarlyFrame, behind, cycle,
                                  static_cast<std::uint16_t>(slot), static_cast<std::uint8_t>(channel)});
}

void TimingAccount::frames_lost(Microticks noticed, Duration late, std::int64_t cycle, int slot,
                                schedules::Channel channel, std::uint32_t count) {
  counts_.frames_lost += count;
  sink_.on(records::TimingProblem{stamp_(noticed), records::kFramesLost, late, cycle, static_cast<std::uint16_t>(slot),
                                  static_cast<std::uint8_t>(channel), count});
}

void TimingAccount::record(Microticks now, const records::BinnedDurations& floor, const bus::LiveCounts& medium,
                           std::uint64_t dropped) {
  const records::Stamp at = stamp_(now);
  const auto tell = [&](std::uint8_t of, const records::BinnedDurations& lateness) {
    sink_.on(records::LatenessHistogram{at, of, lateness.longest(), lateness.counts()});
  };
  tell(records::kLatenessOfWakeUps, wake_ups);
  tell(records::kLatenessOfFloor, floor);
  tell(records::kLatenessOfDepartures, departures);
  tell(records::kLatenessOfArrivals, arrivals);
  tell(records::kLatenessOfTransits, transits);
  sink_.on(records::MediumCounts{at, medium.sent, medium.received, medium.not_sent, medium.lost, medium.foreign,
                                 medium.malformed, dropped});
}

}  // namespace ttf::runner
