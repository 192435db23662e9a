// Listens to the real nodes of a launch, and keeps their accounts.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bus/ports/listener.h"
#include "cli/launch/external/account.h"
#include "cli/launch/external/in_order.h"
#include "cli/launch/external/judge.h"
#include "cli/node_set/node_set.h"
#include "cli/supervision/supervisor.h"
#include "core/ids.h"

namespace ttf::cli::launch::external {

class Listening {
 public:
  // `nodes`: the real ones. `set` must outlive the object, and its medium have listeners. Throws InputError if an interface
  // is unsuitable.
  Listening(const node_set::NodeSet& set, std::vector<NodeId> nodes);

  // `origin` is the drive's time 0.
  void begin(bus::ports::MachineTime origin);
  // Takes in all arrivals.
  void take_in();

  // Returns no value for a node that is not real.
  std::optional<Account> account(NodeId node, bus::ports::MachineTime now) const;
  supervision::ExternalHealth health(NodeId node, bus::ports::MachineTime now) const;
  // Returns the accounts at the end of the drive, in the given order.
  std::vector<Account> accounts(bus::ports::MachineTime now) const;
  // Returns sentences about the listener's own losses.
  std::vector<std::string> warnings() const;

 private:
  const node_set::NodeSet& set_;
  const std::vector<NodeId> nodes_;
  Judge judge_;
  InOrder in_order_;
  std::unique_ptr<bus::ports::Listener> listener_;
  std::optional<bus::ports::MachineTime> origin_;
};

}  // namespace ttf::cli::launch::external
