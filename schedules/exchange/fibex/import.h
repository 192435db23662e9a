// Imports a FlexRay cluster from a FIBEX file (3.1; 2.0 and 4.1 where they agree): the timing, controllers,
// slots, PDUs and signals.
//
// What a cluster file cannot say is kept beside it and named: PDUs that are no lists of ours
// (schedules/exchange/fibex/lists.h) and what they mean, elements that are not understood. What FIBEX does not say and
// a cluster file needs is assumed, by a rule where one parameter follows from others, and marked; tasks,
// sensors and CANs are left to be written.
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
  std::string reason;  // why it is no list
};

struct FibexImport {
  model::Cluster cluster;                      // name, flexray, nodes without tasks, lists, frames
  std::set<std::string, std::less<>> assumed;  // paths of parameters the file does not state: "flexray.gdNIT"
  std::vector<ForeignPdu> foreign;
  std::vector<std::string> contents;               // of each frame: foreign PDUs in it, in words; or empty
  std::vector<std::vector<std::string>> receives;  // of each node: lists and frames it takes in
  std::vector<Finding> left_out;                   // each path once, in the order of its first line
};

// Both throw InputError: damaged XML, missing or illegal values, broken references, each with its line.
FibexImport import_fibex(const std::string& path);
FibexImport parse_fibex(std::string text, std::string name);

// A cluster file that schedules/file/loader.h reads: what was imported, and what is left to do in comments.
std::string skeleton_yaml(const FibexImport& import);

}  // namespace ttf::schedules::exchange::fibex
