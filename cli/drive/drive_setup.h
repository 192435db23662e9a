// Shared parts of the commands that run a drive: their input, the log, and the findings from the records.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cli/drive/run_outputs.h"
#include "evaluation/accuracy/drive_measures.h"
#include "evaluation/ages/stage_account.h"
#include "evaluation/cluster/startup_account.h"
#include "evaluation/driving/driving_account.h"
#include "evaluation/faults/fault_account.h"
#include "nodes/foreign/libraries.h"
#include "recording/log/manifest.h"
#include "recording/log/writer.h"
#include "recording/osi/truth_trace.h"
#include "recording/records/records.h"
#include "recording/rows/laser_radar_file.h"
#include "schedules/model/cluster.h"
#include "sim/drives/scenario.h"

namespace ttf::cli::drive {

// Returns a checked cluster, ready for a drive. Throws InputError.
schedules::model::Cluster checked_cluster(const std::string& file);
// Returns the cluster of the scenario's strategy. An unreadable file counts as the scenario's error, with its line.
schedules::model::Cluster checked_cluster(const sim::drives::Scenario& scenario,
                                          fusion::strategies::StrategyKind strategy);

// The recording of --input: its observations, and the file's facts for the manifest. The name omits the
// folder, so that a log does not depend on the file's place.
struct Recording {
  std::shared_ptr<const recording::rows::RecordedInput> rows;
  std::string name, hash;
};
Recording read_recording(const std::string& path);

// The trace of --truth; null without one.
std::shared_ptr<const recording::osi::TruthTrace> read_truth(const std::string& path);

recording::log::LogManifest manifest_of(const sim::drives::Scenario& scenario, const schedules::model::Cluster& cluster,
                                        fusion::strategies::StrategyKind strategy, std::uint64_t seed,
                                        const Recording& recording, const nodes::foreign::StepFolder* steps = nullptr,
                                        const std::vector<NodeId>& externals = {});
// Opens a log and attaches its scenario and cluster.
std::unique_ptr<recording::log::LogWriter> begin_log(const std::string& path,
                                                     const recording::log::LogManifest& manifest,
                                                     const sim::drives::Scenario& scenario,
                                                     const schedules::model::Cluster& cluster);

// Returns the values of --strategy.
std::vector<std::string> strategy_names();
// Parses --strategy. Throws InputError for an unknown name.
fusion::strategies::StrategyKind strategy_of(const std::string& name);
// Does the same, but returns all strategies for an empty name.
std::vector<fusion::strategies::StrategyKind> chosen(const std::string& name);
// Parses --seed: the rule of a scenario's seed, and decimal digits only.
std::uint64_t seed_of(const std::string& text);

// Sets the scenario's duration from --duration, in seconds. `name` is the drive's in messages.
void set_duration(sim::drives::Scenario& scenario, const std::string& name, const std::string& text);
inline constexpr Duration kLongestDrive = Duration::milliseconds(3'600'000);  // same as in a scenario

// Returns the folder for results without --out. Throws InputError if the scenario's name leads elsewhere.
std::string folder_of(const sim::drives::Scenario& scenario);
// Returns its name within out/. Throws the same.
std::string named_folder(const sim::drives::Scenario& scenario);

// Turns a drive's records into the findings for tables and JSON.
class DriveJudge {
 public:
  // `until`: the end of the recording that the drive plays, if it plays one.
  DriveJudge(const sim::drives::Scenario& scenario, const schedules::model::Cluster& cluster,
             fusion::strategies::StrategyKind strategy, std::optional<TrueTime> until = std::nullopt);
  DriveJudge(const DriveJudge&) = delete;
  DriveJudge& operator=(const DriveJudge&) = delete;
  std::vector<recording::records::Sink*> sinks();
  // Fills in summary, stages, startup and faults. Called once, at the end of the drive.
  void finish(StrategyResult& result);

 private:
  const sim::drives::Scenario& scenario_;
  const schedules::model::Cluster& cluster_;
  const faults::FaultPlan plan_;
  evaluation::accuracy::DriveMeasures measures_;
  evaluation::ages::StageAccount stages_;
  evaluation::cluster::StartupAccount startup_;
  std::optional<evaluation::driving::DrivingAccount> driving_;  // if commands drive the vehicle
  evaluation::faults::FaultAccount faults_;
};

}  // namespace ttf::cli::drive
