// The topics of a node in real time under ROS 2's names (docs/media/dds.md). The fusion node publishes images and
// tracks, the first sensor's device the truth at its measurements, every node its health.
#pragma once

#include <memory>
#include <vector>

#include "cli/node_set/node_set.h"
#include "nodes/runner/drive_clock.h"
#include "nodes/runner/runner.h"
#include "recording/records/records.h"
#include "sim/drives/surroundings.h"

namespace ttf::cli::node_set {

// Throws InputError if the set or the environment rule out topics.
void check_topics(const NodeSet& set);
// Throws std::runtime_error if DDS cannot publish here and now.
void try_topics(const NodeSet& set);

class LiveTopics {
 public:
  virtual ~LiveTopics() = default;
  // Returns the sinks for the node's records.
  virtual std::vector<recording::records::Sink*> sinks() = 0;
  virtual void health(const nodes::runner::Health& health, TrueTime at) = 0;
};

// `around` must outlive the topics. Throws std::runtime_error if DDS does not start.
std::unique_ptr<LiveTopics> make_topics(const NodeSet& set, NodeId node, const nodes::runner::DriveClock& clock,
                                        const sim::drives::Surroundings& around);

}  // namespace ttf::cli::node_set
