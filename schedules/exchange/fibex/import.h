// Imports a FlexRay cluster from a FIBEX file (3.1; 2.0 and 4.1 where they agree): the timing, controllers,
// slots, PDUs and signals.
//
// Content that a cluster file cannot express is kept beside it and named: PDUs other than our lists
// (schedules/exchange/fibex/lists.h) with their meanings, and unknown elements. Values that FIBEX omits and a
// cluster file needs are assumed and marked, by a rule if the parameter follows from others. The cluster describes no
// tasks (model::Cluster::describes_tasks()): tasks, sensors and CANs are left to the author.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "core/errors.h"
#include "schedules/exchange/fibex/file.h"
#include "schedules/model/cluster.h"

namespace ttf::schedules::exchange::fibex {

struct ForeignPdu {
  FibexPdu pdu;
  std::string reason;  // why it is not a list
};

struct FibexImport {
  model::Cluster cluster;                      // name, flexray, nodes without tasks, lists, frames
  std::set<std::string, std::less<>> assumed;  // paths of parameters that the file omits: "flexray.gdNIT"
  std::vector<ForeignPdu> foreign;
  std::vector<std::string> contents;               // by frame: a description of its foreign PDUs, or empty
  std::vector<std::vector<std::string>> receives;  // by node: the lists and frames it receives
  std::vector<Finding> left_out;                   // each path once, in the order of its first line
};

// Both throw InputError: damaged XML, missing or illegal values, broken FIBEX references, each with its line.
FibexImport import_fibex(const std::string& path);
FibexImport parse_fibex(std::string text, std::string name);

// Returns a cluster file that schedules/file/loader.h reads: the imported content, with open tasks in comments.
std::string skeleton_yaml(const FibexImport& import);

}  // namespace ttf::schedules::exchange::fibex
