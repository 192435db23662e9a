// A launch in virtual time: the exchange supervisor, and the merge of the logs.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bus/dds/exchange/exchange_supervisor.h"
#include "cli/drive/run_outputs.h"
#include "cli/launch/external/account.h"
#include "cli/launch/launch_plan.h"
#include "cli/node_set/node_set.h"
#include "cli/supervision/supervisor.h"

namespace ttf::cli::launch {

class VirtualLaunch {
 public:
  // `plan` must outlive the object.
  explicit VirtualLaunch(const LaunchPlan& plan);

  // Announces each ended process as gone, so that the others continue without it; adds up the nodes' outcomes.
  supervision::Hooks hooks();
  // Merges the nodes' logs into STRATEGY.mcap in the folder and judges the drive. An unreadable log is left
  // out with a warning; without any readable log there is no value.
  std::optional<drive::StrategyResult> result(const std::vector<std::string>& logs) const;
  Duration driven() const { return set_.scenario.duration; }
  // Returns the states of the nodes' controllers from the records alone; empty off FlexRay, and without records.
  std::vector<std::string> states_at_end(const supervision::HealthTable&, const drive::StrategyResult* result) const;
  std::vector<external::Account> accounts() const { return {}; }  // real nodes keep real time
  std::vector<std::string> warnings() const { return {}; }

 private:
  const node_set::NodeSet& set_;
  bus::dds::exchange::ExchangeSupervisor exchange_;
  sim::drives::DriveOutcome outcome_;
};

}  // namespace ttf::cli::launch
