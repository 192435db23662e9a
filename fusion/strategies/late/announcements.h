// The scheduled instants that are announced to the clones (fusion/oosm/clone.h), and their stamps.
//
// A list belongs to a scheduled instant, up to the error of its clock. When a list newer than all before is
// taken in, time passes the scheduled instants up to its own. The method clones the state at each instant whose
// list is missing. An instant's stamp is the schedule's own, (instant, sensor, 0): the list's number and clock
// reading are unknown beforehand.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "fusion/sensors/observation.h"
#include "fusion/strategies/late/pasts.h"
#include "fusion/strategies/scheduled_instants.h"
#include "fusion/strategies/strategy.h"

namespace ttf::fusion::strategies::late {

class Announcements {
 public:
  // Announces instants of the scheduled sensors only.
  explicit Announcements(std::span<const SensorTiming> sensors);

  // Returns when a list was measured: near an announced instant, or at its own stamp.
  When when(const sensors::ObservationList& list) const;
  // Returns the stamps to announce before taking this list, which is newer than all before; valid until the
  // next call. Each sensor has at most its newest kClones; instants before the first list are left out.
  std::span<const oosm::Stamp> pass(const sensors::ObservationList& list);

 private:
  struct Sensor {
    SensorId sensor{};
    ScheduledInstants instants;
    std::optional<GlobalTime> next{};  // the first instant that time has not passed
  };
  static oosm::Stamp stamp_of(SensorId sensor, GlobalTime instant) { return {instant, {sensor, 0}}; }
  // Returns the scheduled instant of this list, or no value if none matches its stamp.
  std::optional<GlobalTime> instant_of(const sensors::ObservationList& list) const;

  std::vector<Sensor> sensors_;
  std::vector<oosm::Stamp> due_;
};

}  // namespace ttf::fusion::strategies::late
