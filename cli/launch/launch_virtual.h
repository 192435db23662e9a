// A launch in virtual time: who watches over the exchange between the nodes, and what becomes of their logs.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bus/dds/exchange/exchange_supervisor.h"
#include "cli/drive/run_outputs.h"
#include "cli/node_set/node_set.h"
#include "cli/supervision/supervisor.h"

namespace ttf::cli::launch {

class VirtualLaunch {
 public:
  explicit VirtualLaunch(const node_set::NodeSet& set);

  // A process that ends is announced gone, so that the others go on without it; what a node says it did is added up.
  supervision::Hooks hooks();
  // The nodes' logs as one, STRATEGY.mcap in the folder, and what is made of it. A log that cannot be read at all is
  // left out, with a warning; nothing where none can.
  std::optional<drive::StrategyResult> result(const std::vector<std::string>& logs) const;
  // Of the nodes' controllers, from the records, which are all that tells; empty off FlexRay, and without records.
  std::vector<std::string> states_at_end(const supervision::HealthTable&, const drive::StrategyResult* result) const;
  std::vector<std::string> warnings() const { return {}; }

 private:
  const node_set::NodeSet& set_;
  bus::dds::exchange::ExchangeSupervisor exchange_;
  drives::DriveOutcome outcome_;
};

}  // namespace ttf::cli::launch
