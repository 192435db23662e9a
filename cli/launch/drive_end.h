// The nodes in and out of operation at the end of a launched drive. Every process may end well although a
// node never joined the cluster, or left it for good.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/drive/launch_findings.h"
#include "cli/supervision/supervisor.h"
#include "evaluation/cluster/startup_account.h"
#include "schedules/model/cluster.h"

namespace ttf::cli::launch {

struct NodeAtEnd {
  std::string name;
  bool on_flexray = false;
  std::optional<supervision::Ending> ending;  // its last process's; no value without a process
  std::string state;                          // its controller's last known state; empty off FlexRay
  bool external = false;                      // a real node: without a process, and in operation if the state is empty
};

struct DriveEnd {
  // Nodes whose process failed, and nodes on FlexRay that were not normal active; in the given order.
  std::vector<drive::AbsentNode> absent;
  bool nobody = false;  // true if no node of the launch on FlexRay was in operation

  // Returns "a, b were not in operation at the end: integration listen", or "" if all were.
  std::string sentence() const;
};
DriveEnd drive_end(const std::vector<NodeAtEnd>& nodes);

// Returns each node's last state by a virtual drive's records. A node without a change keeps its first state;
// a node off FlexRay has "".
std::vector<std::string> states_at_end(const schedules::model::Cluster& cluster, bool cold,
                                       const std::vector<evaluation::cluster::NodeStartup>& changes);

// Records the endings of the processes.
class EndWatch {
 public:
  explicit EndWatch(std::size_t nodes) : endings_(nodes) {}

  supervision::Hooks around(supervision::Hooks hooks);  // calls `hooks` as well; the watch must outlive it
  bool begun() const { return begun_; }                 // whether the start barrier was passed
  // Returns the nodes with the states of their controllers. `external`: indices of real nodes.
  std::vector<NodeAtEnd> nodes(const schedules::model::Cluster& cluster, const std::vector<std::string>& states,
                               const std::vector<NodeId>& external = {}) const;

 private:
  std::vector<std::optional<supervision::Ending>> endings_;
  bool begun_ = false;
};

}  // namespace ttf::cli::launch
