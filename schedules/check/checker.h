// Proves a cluster consistent before anything runs, beyond the key-by-key tests of the loader.
//
// The rules and their sources:
//   constraints  those of FlexRay 2.1A, annex B, on single parameters: one table (schedules/check/constraints.h)
//   cycle        bit and baud rate, propagation delays, frame ids
//   star         a guardian needs a star
//   clocks       drifts, sync and startup nodes, key slots, wake-up channels
//   slots        one owner per slot, cycle and channel; a sender is attached to the frame's channels; the payload has
//                room for the fragment and any network management vector; a PDU's fragments are complete
//   dynamic      minislots that all clocks count alike, frames that end within the segment
//                (schedules/analysis/minislots.h)
//   CAN          frames fit, identifiers are unique, worst-case load, responses within periods
//                (schedules/analysis/can_load.h)
//   tasks        no overlap, deadlines with every wait for other tasks, an end before the next activation
//                (schedules/analysis/responses.h)
//   loops        a sensor that follows its host does so in a closed loop (schedules/analysis/sensor_loop.h)
//   modes        modes of tasks whose instants and lists meet no others (schedules/modes/detection_modes.h)
//   flow         every reader has a writer and the reverse, sensors have their tasks, no list flows in a ring
//   round        measurements are fused within a round of cycles, so that their stamps are distinct
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include "core/errors.h"
#include "core/ids.h"
#include "core/time.h"
#include "schedules/model/cluster.h"

namespace ttf::schedules::check {

// Returns all findings in a fixed order; empty for a consistent cluster. A bus description is checked as far as the bus
// goes (schedules/check/rules.h); it cannot run.
std::vector<Finding> check(const model::Cluster& cluster);

// Reads a cluster file (schedules/file/loader.h) and checks it. Throws InputError with the findings of either.
model::Cluster load_checked_cluster(const std::string& path);

// Collects findings about one cluster; shared by the checker's parts.
class ClusterFindings {
 public:
  explicit ClusterFindings(const model::Cluster& cluster) : cluster_(cluster) {}
  // Adds a finding about a parameter of the file by its path ("flexray.gdNIT"), with its line.
  void parameter(const std::string& path, const std::string& value, const std::string& expected);
  void at(int line, const std::string& key, const std::string& value, const std::string& expected);
  std::size_t size() const { return list_.size(); }
  const model::Cluster& cluster() const { return cluster_; }
  std::vector<Finding> take() { return std::move(list_); }

 private:
  const model::Cluster& cluster_;
  std::vector<Finding> list_;
};

// Returns for example "nodes.fusion.tasks.fuse".
std::string task_path(const model::Node& node, const model::Task& task);
// Returns for example "can.laser_can.messages[0]", as the loader names it. The message is one of the CAN's.
std::string message_path(const model::CanBus& bus, const model::CanMessage& message);
// Returns for example "frames[9] (slot 22)": the entry as the loader names it, and which of its slots. For a frame that is
// not from a cluster file it returns "slot 22".
std::string frame_path(const model::FrameSlot& frame);
// Returns for example "line 304", or "paper.yaml:304" for a line that the cluster's file inherits.
std::string place_text(const model::Cluster& cluster, int line);
// Returns for example "2.5 ms".
std::string ms(Duration duration);
std::string number(std::int64_t value);
// Return picoseconds as text: "0.1 us", "12.5 ns".
std::string us(std::int64_t ps);
std::string ns(std::int64_t ps);

template <std::size_t N> bool is_one_of(const std::int64_t (&allowed)[N], std::int64_t value) {
  return std::find(std::begin(allowed), std::end(allowed), value) != std::end(allowed);
}

void check_cycle(const model::Cluster& cluster, ClusterFindings& findings);
void check_clocks(const model::Cluster& cluster, ClusterFindings& findings);
void check_slots(const model::Cluster& cluster, ClusterFindings& findings);
void check_dynamic(const model::Cluster& cluster, ClusterFindings& findings);  // after check_slots()
void check_can(const model::Cluster& cluster, ClusterFindings& findings);
void check_tasks(const model::Cluster& cluster, ClusterFindings& findings);
// For a node whose tasks passed check_tasks(): deadlines with other tasks' executions, and the periods of its
// CAN lists.
void check_responses(const model::Cluster& cluster, NodeId node, ClusterFindings& findings);
void check_flow(const model::Cluster& cluster, ClusterFindings& findings);   // readers, writers, sensors
void check_loops(const model::Cluster& cluster, ClusterFindings& findings);  // after all those
void check_modes(const model::Cluster& cluster, ClusterFindings& findings);  // after all those
void check_round(const model::Cluster& cluster, ClusterFindings& findings);  // after all others

}  // namespace ttf::schedules::check
