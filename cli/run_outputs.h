// What `ttfusion run` leaves behind for people: tables, pictures, an index page; and its JSON.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "experiments/fault_report.h"
#include "experiments/measures.h"
#include "experiments/startup_account.h"
#include "fusion/strategy.h"
#include "nodes/scenario.h"
#include "schedules/cluster.h"
#include "sim/drive.h"

namespace ttf::cli {

struct StrategyResult {
  fusion::StrategyKind strategy{};
  schedules::Cluster cluster;
  sim::DriveOutcome outcome;
  experiments::DriveSummary summary;
  std::vector<experiments::NodeStartup> startup;   // nodes that started up or changed their state
  experiments::FaultFindings faults;
  std::vector<NodeId> fault_free;                  // to the end, of those on FlexRay
  std::string log_path;
  std::string content_hash;
};

// The comparison table, a column a strategy.
std::string comparison_table(const std::vector<StrategyResult>& results);
nlohmann::ordered_json to_json(const nodes::Scenario& scenario, std::uint64_t seed,
                               const std::vector<StrategyResult>& results);
// Timing diagrams, position plots and index.html in `folder`, from the logs alone.
void write_pictures(const nodes::Scenario& scenario, const std::vector<StrategyResult>& results,
                    const std::string& folder);

}  // namespace ttf::cli
