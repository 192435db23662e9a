// A launch in real time: the instant at which all begin, and what becomes of their logs.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "bus/ports/live_medium.h"
#include "cli/drive/run_outputs.h"
#include "cli/node_set/node_set.h"
#include "cli/supervision/supervisor.h"

namespace ttf::cli::launch {

class LiveLaunch {
 public:
  explicit LiveLaunch(const node_set::NodeSet& set) : set_(set) {}

  // All are told one instant, some hundred milliseconds ahead. Who comes later joins a drive that is under way.
  supervision::Hooks hooks();
  // The nodes' logs and the truth as one, STRATEGY.mcap in the folder, and what is made of it. A log that cannot be
  // read at all is left out, with a warning; nothing where none can.
  std::optional<drive::StrategyResult> result(const std::vector<std::string>& logs) const;
  // Of the nodes' controllers, as they said it last; empty off FlexRay.
  std::vector<std::string> states_at_end(const supervision::HealthTable& health, const drive::StrategyResult*) const;
  // What the kernel did not grant the nodes' processes, each sentence once, with how many it is of.
  std::vector<std::string> warnings() const;

 private:
  const node_set::NodeSet& set_;
  std::map<std::string, std::set<std::size_t>> not_granted_;  // by sentence, whom
  std::optional<bus::ports::MachineTime> origin_;
  drives::DriveOutcome outcome_;
};

}  // namespace ttf::cli::launch
