// One drive of a scenario with one strategy: the cluster, its world and the reference.
//
// sim/drives/observer.h records the truth and the reference's fixes; no node does.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/ids.h"
#include "fusion/strategies/strategy.h"
#include "nodes/foreign/libraries.h"
#include "recording/records/records.h"
#include "recording/rows/laser_radar_file.h"
#include "schedules/model/cluster.h"
#include "sensors/scene.h"
#include "sim/drives/scenario.h"
#include "sim/engine/cluster_simulation.h"
#include "sim/faults/injector.h"

namespace ttf::sim::drives {

struct DriveConfig {
  const Scenario* scenario = nullptr;
  const schedules::model::Cluster* cluster = nullptr;
  fusion::strategies::StrategyKind strategy{};
  std::uint64_t seed = 0;
  std::uint32_t replication = 0;
  std::shared_ptr<const recording::rows::RecordedInput> recorded;
  // Null: the whole cluster. Otherwise one node of it, while the others run in processes of their own. The drive
  // then records that node's share; all shares together equal the records of the whole cluster, except for
  // PrecisionSample.
  sim::processes::TurnTaking* others = nullptr;
  // Whether to compare the clocks; the records are the same otherwise, except for PrecisionSample.
  bool compares_clocks = true;
  // Whether the private CANs go bit by bit; the records are the same otherwise.
  bool cans_bit_by_bit = false;
  // Where the cluster's libraries may be loaded from; null: nowhere.
  const nodes::foreign::StepFolder* steps = nullptr;
};

// Results that only the whole drive has; for one node among others, that node's counts and no precision.
struct DriveOutcome {
  Duration precision{};  // if the clocks were compared
  nodes::host::ExecutiveCounts counts;
  double flexray_load = 0.0;     // share of time in which the busier channel is occupied
  std::vector<double> can_load;  // by Cluster::can_buses
  std::uint64_t frames_sent = 0;
  std::vector<sim::faults::Injector::Activation> faults;  // by Scenario::faults
};

// Checks that scenario and cluster match the recording. A cluster with recorded sources needs one, and nodes
// that begin integrated; any other cluster must have none. Throws InputError; run_drive() calls it too.
void check_recording(const Scenario& scenario, const schedules::model::Cluster& cluster, bool given);
// Checks that the strategy can fuse late lists of this cluster as the scenario demands (tracker.late). Throws
// InputError; run_drive() calls it too.
void check_late(const Scenario& scenario, const schedules::model::Cluster& cluster,
                fusion::strategies::StrategyKind strategy);
// Checks that the strategy works with the activation of the cluster's fusion task: TT does not if lists activate
// it. Throws InputError; run_drive() calls it too.
void check_fusion(const schedules::model::Cluster& cluster, fusion::strategies::StrategyKind strategy);
// Checks that commands drive the scenario's vehicle where the cluster has an actuator, and only there. There is one
// actuator, which is done with a command before the vehicle answers. Sensors see no future. Throws InputError;
// run_drive() calls it too.
void check_loop(const Scenario& scenario, const schedules::model::Cluster& cluster);
// Returns a warning if commands drive the vehicle, and an object follows; else "". Objects' ways are drawn beforehand.
std::string following_warning(const Scenario& scenario);
// Returns a warning for each section of parameters whose step no task of these clusters has, one a line; else "".
std::string unused_sections(const Scenario& scenario, std::span<const schedules::model::Cluster> clusters);
// Returns the time between two readings of commands by the actuator. Without one that check_loop() accepts, it is the
// shortest time allowed.
Duration between_readings(const schedules::model::Cluster& cluster);
// Returns the node with the actuator, if there is one.
std::optional<NodeId> actuator_node(const schedules::model::Cluster& cluster);
// Checks that the cluster describes tasks: a bus description passes the schedule's checks, but no node could run it. Throws
// InputError; run_drive() calls it too.
void check_described(const schedules::model::Cluster& cluster);
// Checks the scenario's demands on the cluster's nodes and the recording before anything starts: faults,
// start-up, late lists. Steps of libraries have a check of their own (nodes/foreign/libraries.h). Throws InputError.
void check_fits(const Scenario& scenario, const schedules::model::Cluster& cluster,
                fusion::strategies::StrategyKind strategy, bool recording_given);

// Runs the drive to its end, with the scenario's faults; their times count from kFirstCycle. Throws InputError
// if scenario, cluster and code do not match.
DriveOutcome run_drive(const DriveConfig& config, recording::records::Sink& out);

// Returns the true time at which the world or the recording starts in this cluster. In a cold drive
// (sim/drives/startup.h) the world moves while the nodes start up: it starts at the earliest supply.
TrueTime drive_start(const schedules::model::Cluster& cluster);

// The drive is judged and drawn from `evaluation_start` to `drive_end`. The scenario's evaluate_from and
// duration both count from the start of cycle 0, even if a recording begins later. In a cold drive, whose cycles
// begin later, they count from the same instant.
TrueTime evaluation_start(const Scenario& scenario);
TrueTime drive_end(const Scenario& scenario);

}  // namespace ttf::sim::drives
