// Which instants a schedule tells the clones of (fusion/oosm/clone.h), and by which stamp.
//
// A list comes from a scheduled instant, give or take what clocks are off. When a list is taken in that is newer than
// all before, time passes the scheduled instants up to its own; of those whose lists are not there, clones are made.
// An instant's stamp is the schedule's own, (instant, sensor, 0): what the list will be numbered, and what its clock
// will read, nobody knows beforehand.
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
  // Of those of the sensors that are scheduled.
  explicit Announcements(std::span<const SensorTiming> sensors);

  // When a list was measured: off an announced instant, or at a stamp of its own.
  When when(const sensors::Scan& scan) const;
  // What is to be announced before this list is taken, which is newer than all before; valid until the next call. Of
  // each sensor the newest kClones at most. Nothing of what lies before the first list.
  std::span<const oosm::Stamp> pass(const sensors::Scan& scan);

 private:
  struct Sensor {
    SensorId sensor{};
    ScheduledInstants instants;
    std::optional<GlobalTime> next{};  // the first that time has not passed
  };
  static oosm::Stamp stamp_of(SensorId sensor, GlobalTime instant) { return {instant, {sensor, 0}}; }
  // The scheduled instant of this list; nothing where its stamp fits none.
  std::optional<GlobalTime> instant_of(const sensors::Scan& scan) const;

  std::vector<Sensor> sensors_;
  std::vector<oosm::Stamp> due_;
};

}  // namespace ttf::fusion::strategies::late
