// What a node in real time publishes under ROS 2's names (docs/ros.md): the fusion node its images and tracks, the
// device of the first sensor the truth, as it is when that measures, and every node its health.
#pragma once

#include <optional>
#include <vector>

#include "bus/dds/ros/publisher.h"
#include "cli/node_set/node_set.h"
#include "drives/observer.h"
#include "drives/surroundings.h"
#include "nodes/runner/drive_clock.h"
#include "nodes/runner/runner.h"
#include "recording/records/records.h"

namespace ttf::cli::node_set {

// Whether topics can be published as the set and the environment say; throws InputError else.
void check_topics(const NodeSet& set);
// Whether DDS lets us, here and now; throws std::runtime_error else.
void try_topics(const NodeSet& set);

class LiveTopics {
 public:
  // `around` must outlive it. Throws std::runtime_error where DDS does not start.
  LiveTopics(const NodeSet& set, NodeId node, const nodes::runner::DriveClock& clock,
             const drives::Surroundings& around);

  // Who is to hear the node's records.
  std::vector<recording::records::Sink*> sinks();
  void health(const nodes::runner::Health& health, TrueTime at);

 private:
  std::string name_;
  bus::dds::ros::RosPublisher publisher_;
  std::optional<drives::Observer> truth_;
};

}  // namespace ttf::cli::node_set
