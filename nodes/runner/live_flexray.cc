#include "nodes/runner/live_flexray.h"

namespace ttf::nodes::runner {

LiveFlexRay::LiveFlexRay(const DriveClock& clock, const MachineClock& machine_clock,
                         const timebase::Oscillator& oscillator, Duration latest, bus::ports::LiveMedium& medium,
                         const ArrivalWindow& arrival_window, TimingAccount& account)
    : clock_(clock), machine_clock_(machine_clock), oscillator_(oscillator), latest_(latest), medium_(medium),
      arrival_window_(arrival_window), account_(account) {}

bool LiveFlexRay::may_leave(schedules::model::Channel channel, int slot, Microticks start) {
  const Duration late = machine_clock_.now() - due(start);
  if (late <= latest_) return true;
  const auto& clock = controller_->clock();
  account_.slot_missed(now_, late, clock ? clock->cycle() : 0, slot, channel);
  return false;
}

void LiveFlexRay::transmit(const bus::ports::Transmission& transmission) {
  const bus::ports::MachineTime at = due(transmission.start);
  account_.departures.add(machine_clock_.now() - at);
  bus::ports::LiveSignal signal;
  signal.channel = transmission.channel;
  signal.signal = transmission.signal;
  signal.slot = transmission.slot;
  signal.bytes = transmission.bytes;
  signal.states_late = transmission.signal == bus::ports::Signal::kFrame && transmission.content.header.sync;
  if (transmission.signal != bus::ports::Signal::kFrame) signal.duration = due(transmission.end) - at;
  (void)medium_.send(signal, at);  // the medium counts it if there is no room
}

}  // namespace ttf::nodes::runner
