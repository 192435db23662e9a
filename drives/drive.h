// One drive of a scenario with one strategy: the cluster, the world it drives through, and the reference beside it.
//
// Truth and reference fixes are recorded here, not by any node (drives/observer.h).
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "drives/scenario.h"
#include "fusion/strategies/strategy.h"
#include "nodes/sensing/scene.h"
#include "recording/records/records.h"
#include "recording/rows/laser_radar_file.h"
#include "schedules/model/cluster.h"
#include "sim/crank/cluster_simulation.h"
#include "sim/faults/injector.h"

namespace ttf::drives {

struct DriveConfig {
  const Scenario* scenario = nullptr;
  const schedules::model::Cluster* cluster = nullptr;
  fusion::strategies::StrategyKind strategy{};
  std::uint64_t seed = 0;
  std::uint32_t replication = 0;
  std::shared_ptr<const recording::rows::RecordedInput> recorded;
  // Null: the whole cluster. Else one node of it, the others being in processes of their own: what is recorded is that
  // node's share, and all shares together are what is recorded where this is null, but for PrecisionSample.
  sim::processes::TurnTaking* others = nullptr;
  // Whether anybody wants the clocks compared; what is recorded is the same otherwise, but for PrecisionSample.
  bool compares_clocks = true;
};

// What only the whole run knows; of one node among others, that node's counts and no precision.
struct DriveOutcome {
  Duration precision{};  // where the clocks were compared
  nodes::host::ExecutiveCounts counts;
  double flexray_load = 0.0;     // share of the time in which the busier channel is taken
  std::vector<double> can_load;  // by Cluster::can_buses
  std::uint64_t frames_sent = 0;
  std::vector<sim::faults::Injector::Activation> faults;  // by Scenario::faults
};

// Whether scenario and cluster take what they are given: a cluster with recorded sources needs a recording and nodes
// that begin integrated, and any other has no use for a recording. Throws InputError; run_drive() asks it, too.
void check_recording(const Scenario& scenario, const schedules::model::Cluster& cluster, bool given);
// Whether that strategy can take late lists of this cluster in as the scenario says (tracker.late). Throws InputError;
// run_drive() asks it, too.
void check_late(const Scenario& scenario, const schedules::model::Cluster& cluster,
                fusion::strategies::StrategyKind strategy);
// Whether that strategy can fuse when the cluster has it fuse: TT not when lists arrive. Throws InputError; run_drive()
// asks it, too.
void check_fusion(const schedules::model::Cluster& cluster, fusion::strategies::StrategyKind strategy);
// The same of all that a scenario says of its cluster's nodes, and of the recording: faults, start-up, late lists.
// Throws InputError, so that nothing has to be begun to find it out.
void check_fits(const Scenario& scenario, const schedules::model::Cluster& cluster,
                fusion::strategies::StrategyKind strategy, bool recording_given);

// Runs the drive to its end, with the scenario's faults; their times count from kFirstCycle. Throws InputError where
// scenario, cluster and code do not fit together.
DriveOutcome run_drive(const DriveConfig& config, recording::records::Sink& out);

// True time at which the drive (world or recording) starts in this cluster. In a cold one (drives/startup.h) the
// world moves while the nodes start up: it starts when the first supply may come.
TrueTime drive_start(const schedules::model::Cluster& cluster);

// From `evaluation_start` to `drive_end` the drive is judged and drawn: both the scenario's evaluate_from and its
// duration count from the start of cycle 0, whenever a recording begins; in a cold drive, whose cycles begin later,
// from the same instant.
TrueTime evaluation_start(const Scenario& scenario);
TrueTime drive_end(const Scenario& scenario);

}  // namespace ttf::drives
