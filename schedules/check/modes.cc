// The checker's rule about modes: detections end before the next ones begin, and no list is torn or replaced
// (schedules/modes/detection_modes.h).
#include "schedules/check/checker.h"
#include "schedules/modes/stated.h"

namespace ttf::schedules::check {

void check_modes(const model::Cluster& cluster, ClusterFindings& findings) {
  if (findings.size() > 0) return;  // slots and clocks must be sound
  for (const modes::StatedModes& stated : modes::stated_modes(cluster))
    for (const Finding& one : modes::unsound(cluster, stated.detector, stated.modes, stated.grid))
      findings.at(one.line, one.key, one.value, one.expected);
}

}  // namespace ttf::schedules::check
