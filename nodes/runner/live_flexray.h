// The FlexRay port of a node in real time. The controller's frames go to the medium when they are due; a frame
// too late for its arrival window is not sent.
//
// The laws of bus/ports/flexray_port.h hold except L6 and the lengths of bits: simultaneous frames do not
// collide on such a medium, and a frame arrives at once. The runner hands it over when it would have ended
// (nodes/runner/arrival_window.h).
#pragma once

#include <cstdint>

#include "bus/controller/controller.h"
#include "bus/ports/flexray_port.h"
#include "bus/ports/live_medium.h"
#include "nodes/runner/arrival_window.h"
#include "nodes/runner/drive_clock.h"
#include "nodes/runner/machine_clock.h"
#include "nodes/runner/timing_account.h"
#include "timebase/oscillator.h"

namespace ttf::nodes::runner {

class LiveFlexRay final : public bus::ports::FlexRayPort {
 public:
  // `latest`: the largest lateness behind the action point, in real time.
  LiveFlexRay(const DriveClock& clock, const MachineClock& machine_clock, const timebase::Oscillator& oscillator,
              Duration latest, bus::ports::LiveMedium& medium, const ArrivalWindow& arrival_window,
              TimingAccount& account);

  bool may_leave(schedules::model::Channel channel, int slot, Microticks start) override;
  void transmit(const bus::ports::Transmission& transmission) override;
  Microticks handed_over_within() const override { return arrival_window_.handed_over_within(); }
  bool carrier(schedules::model::Channel channel) const override { return arrival_window_.carrier(channel, now_); }

  // Sets the node's instant, which holds until the next call.
  void set_now(Microticks now) { now_ = now; }
  // Sets the controller that uses this port, before anything is sent.
  void bind(const bus::controller::FlexRayController& controller) { controller_ = &controller; }

 private:
  bus::ports::MachineTime due(Microticks start) const { return clock_.machine_time(oscillator_.time_of(start)); }

  const DriveClock& clock_;
  const MachineClock& machine_clock_;
  const timebase::Oscillator& oscillator_;
  const Duration latest_;
  bus::ports::LiveMedium& medium_;
  const ArrivalWindow& arrival_window_;
  TimingAccount& account_;
  Microticks now_{};
  const bus::controller::FlexRayController* controller_ = nullptr;
};

}  // namespace ttf::nodes::runner
