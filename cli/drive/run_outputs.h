// The results of `ttfusion run` for people: tables, pictures, an index page.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "evaluation/accuracy/drive_measures.h"
#include "evaluation/accuracy/service_account.h"
#include "evaluation/ages/stage_account.h"
#include "evaluation/cluster/startup_account.h"
#include "evaluation/driving/driving_account.h"
#include "evaluation/faults/fault_account.h"
#include "evaluation/lateness/lateness_account.h"
#include "evaluation/measures/figures.h"
#include "fusion/strategies/strategy.h"
#include "schedules/model/cluster.h"
#include "sim/drives/drive.h"
#include "sim/drives/played_recording.h"
#include "sim/drives/scenario.h"

namespace ttf::cli::drive {

struct StrategyResult {
  fusion::strategies::StrategyKind strategy{};
  schedules::model::Cluster cluster;
  sim::drives::DriveOutcome outcome;
  evaluation::accuracy::DriveSummary summary;
  std::vector<evaluation::ages::SensorStages> stages;           // latency by stage, for each sensor
  std::vector<evaluation::cluster::NodeStartup> startup;        // nodes that started up or changed their state
  std::optional<evaluation::driving::DrivingFindings> driving;  // only where commands drive the vehicle
  evaluation::faults::FaultFindings faults;
  std::vector<NodeId> fault_free;                                   // until the end; nodes on FlexRay only
  std::optional<evaluation::lateness::RealTimeFindings> real_time;  // only for a drive in real time
  evaluation::accuracy::ServiceFindings service;                    // likewise
  std::optional<sim::drives::RecordingUse> recording;               // only for a drive that plays one
  bool made_track = false;                                          // only told for such a drive
  std::string log_path;
  std::string content_hash;
};
// The result must outlive them.
evaluation::measures::DriveFigures figures_of(const StrategyResult& result);

// A scenario that was driven with some strategies.
struct ScenarioResults {
  std::string name;
  std::vector<StrategyResult> results;
};
// Returns the comparison table, with one column per strategy. Several scenarios stand side by side.
std::string comparison_table(const std::vector<StrategyResult>& results);
std::string comparison_table(const std::vector<ScenarioResults>& scenarios);
// Returns all files that write_pictures() may write for this strategy.
std::vector<std::string> picture_files(std::string_view strategy);
// Writes timing diagrams, position plots and index.html into `folder`, from the logs alone.
void write_pictures(const sim::drives::Scenario& scenario, const std::vector<StrategyResult>& results,
                    const std::string& folder);

}  // namespace ttf::cli::drive
