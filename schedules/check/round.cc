// The checker's rule about the round of cycles: it is long enough to separate the stamps of measurements.
//
// Nodes agree on the cycle counter, and each counts its wraps itself. A stamp is thus known modulo a round, and a fusing task takes
// it for an instant up to seven eighths of a round ago (nodes/host/step.h). With 64 cycles of some milliseconds that is more than
// any list takes. A round of few cycles (FlexRay 3.0.1) may be too short.
#include <fmt/format.h>

#include "schedules/analysis/ages.h"
#include "schedules/check/checker.h"

namespace ttf::schedules::check {

void check_round(const model::Cluster& cluster, ClusterFindings& findings) {
  if (findings.size() > 0 || cycles_per_round(cluster.flexray) == model::kMostCycles) return;
  const Duration distinct_within{cluster.round().ns / 8 * 7};
  const auto check = [&](const std::vector<analysis::AgePath>& paths) {
    for (const analysis::AgePath& path : paths)
      if (path.fused_worst >= distinct_within)
        findings.parameter("flexray.gCycleCountMax", number(cluster.flexray.gCycleCountMax),
                           fmt::format("must make a round of cycles of more than {}: {} is up to {} old when it is "
                                       "fused, and stamps are told apart within seven eighths of a round",
                                       ms(Duration{path.fused_worst.ns / 7 * 8}), cluster.sensor(path.sensor).name,
                                       ms(path.fused_worst)));
  };
  check(analysis::measurement_ages(cluster));
  check(analysis::odometry_ages(cluster));
}

}  // namespace ttf::schedules::check
