// The standing of each node of a cluster: in normal operation or not, fault-free or not. A fault-free node in
// normal operation counts.
#pragma once

#include <vector>

#include "core/ids.h"
#include "recording/records/records.h"
#include "schedules/model/cluster.h"

namespace ttf::evaluation::faults {

class Standings {
 public:
  // Nodes on FlexRay are in normal operation from the start, or have to start.
  Standings(const schedules::model::Cluster& cluster, bool begins_integrated);

  std::size_t size() const { return nodes_.size(); }
  bool active(NodeId node) const { return nodes_[index_of(node)].active; }
  bool faulty(NodeId node) const { return node != kNoNode && nodes_[index_of(node)].faulty; }
  bool counts(NodeId node) const { return active(node) && !faulty(node); }
  bool has_to_start(NodeId node) const { return nodes_[index_of(node)].has_to_start; }  // and has not yet
  // H2 (checks.h), at the end of the drive.
  bool never_started(NodeId node) const { return has_to_start(node) && !faulty(node); }
  bool all_fault_free_active() const;

  void becomes_faulty(NodeId node) { nodes_[index_of(node)].faulty = true; }
  // Take a change of state or supply. Return whether the node left normal operation: H1 if it is not faulty.
  bool leaves_by(const recording::records::StateChanged& change);
  bool leaves_by(const recording::records::PowerChanged& power);

 private:
  struct Node {
    bool active = false, faulty = false, has_to_start = false;
  };
  std::vector<Node> nodes_;  // by NodeId
};

}  // namespace ttf::evaluation::faults
