// A launch in real time: the common instant of the begin, and the merge of the logs.
#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "bus/ports/live_medium.h"
#include "cli/drive/run_outputs.h"
#include "cli/launch/external/account.h"
#include "cli/launch/external/listening.h"
#include "cli/launch/launch_plan.h"
#include "cli/node_set/node_set.h"
#include "cli/supervision/supervisor.h"
#include "nodes/runner/vehicle/line.h"
#include "sim/drives/surroundings.h"

namespace ttf::cli::launch {

class LiveLaunch {
 public:
  // `plan` must outlive the object.
  explicit LiveLaunch(const LaunchPlan& plan);

  // Gives all processes one instant, some hundred milliseconds ahead. A later process joins a running drive.
  supervision::Hooks hooks();
  // Merges the nodes' logs and the truth into STRATEGY.mcap in the folder and judges the drive. An unreadable
  // log is left out with a warning; without any readable log there is no value.
  std::optional<drive::StrategyResult> result(const std::vector<std::string>& logs) const;
  // Returns how long the drive went on: less than its duration if it was stopped.
  Duration driven() const;
  // Returns the last reported states of the nodes' controllers, empty off FlexRay. An external node's is the one that was
  // received, empty if it was sending.
  std::vector<std::string> states_at_end(const supervision::HealthTable& health, const drive::StrategyResult*) const;
  // Returns the accounts of external nodes.
  std::vector<external::Account> accounts() const;
  // Returns the privileges that the kernel refused, each sentence once with the number of processes, nodes that saw the
  // vehicle elsewhere, and the losses of the launch's own listening.
  std::vector<std::string> warnings() const;

 private:
  Duration so_far(bus::ports::MachineTime now) const;

  const node_set::NodeSet& set_;
  std::optional<external::Listening> listening_;  // if there are external nodes
  sim::drives::Surroundings around_;
  std::unique_ptr<nodes::runner::vehicle::Line> vehicle_;  // if commands drive it; it receives all of them
  std::map<std::size_t, std::string> vehicle_problems_;    // by node, the last reported
  const std::size_t processes_;
  std::map<std::string, std::set<std::size_t>> not_granted_;  // nodes by sentence
  std::optional<bus::ports::MachineTime> origin_, last_done_;
  std::optional<bus::ports::MachineTime> ended_;  // the first of the nodes that ended together at last
  sim::drives::DriveOutcome outcome_;
};

}  // namespace ttf::cli::launch
