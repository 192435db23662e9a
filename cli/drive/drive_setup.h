// What commands that run a drive have in common: reading what they are given, the log, and what is made of the records.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "cli/drive/run_outputs.h"
#include "drives/scenario.h"
#include "evaluation/accuracy/drive_measures.h"
#include "evaluation/cluster/startup_account.h"
#include "evaluation/faults/fault_account.h"
#include "recording/log/manifest.h"
#include "recording/log/writer.h"
#include "recording/records/records.h"
#include "recording/rows/laser_radar_file.h"
#include "schedules/model/cluster.h"

namespace ttf::cli::drive {

// A cluster that has passed its check, ready to run. Throws InputError.
schedules::model::Cluster checked_cluster(const std::string& file);
// That of the scenario's strategy. One that cannot be read at all is told as the scenario's mistake, with its line.
schedules::model::Cluster checked_cluster(const drives::Scenario& scenario, fusion::strategies::StrategyKind strategy);

// What --input gives: the observations, and what the manifest says of the file they came from. Its name goes without
// the folder, so that a log does not depend on where the file lay.
struct Recording {
  std::shared_ptr<const recording::rows::RecordedInput> rows;
  std::string name, hash;
};
Recording read_recording(const std::string& path);

recording::log::LogManifest manifest_of(const drives::Scenario& scenario, const schedules::model::Cluster& cluster,
                                        fusion::strategies::StrategyKind strategy, std::uint64_t seed,
                                        const Recording& recording);
// A log that has its scenario and cluster attached.
std::unique_ptr<recording::log::LogWriter> begin_log(const std::string& path,
                                                     const recording::log::LogManifest& manifest,
                                                     const drives::Scenario& scenario,
                                                     const schedules::model::Cluster& cluster);

// What --strategy may be.
std::vector<std::string> strategy_names();
// --strategy. Throws InputError where there is no strategy of this name.
fusion::strategies::StrategyKind strategy_of(const std::string& name);
// The same, and all strategies where none is named.
std::vector<fusion::strategies::StrategyKind> chosen(const std::string& name);
// --seed: the same rule as for a scenario's seed, and decimal digits only.
std::uint64_t seed_of(const std::string& text);

// Where results go without --out; a name that leads elsewhere is no name. Throws InputError.
std::string folder_of(const drives::Scenario& scenario);

// Makes of a drive's records what tables and JSON tell of it.
class DriveJudge {
 public:
  DriveJudge(const drives::Scenario& scenario, const schedules::model::Cluster& cluster);
  std::vector<recording::records::Sink*> sinks();
  // At the end of the drive, once. Fills in summary, startup and faults.
  void finish(StrategyResult& result);

 private:
  const drives::Scenario& scenario_;
  const schedules::model::Cluster& cluster_;
  const faults::FaultPlan plan_;
  evaluation::accuracy::DriveMeasures measures_;
  evaluation::cluster::StartupAccount startup_;
  evaluation::faults::FaultAccount faults_;
};

}  // namespace ttf::cli::drive
