// The node set of a launch: the common options of `launch` and `node`, read and checked once, and passed on.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "cli/drive/step_options.h"
#include "cli/live_media/bus.h"
#include "core/ids.h"
#include "core/time.h"
#include "fusion/strategies/strategy.h"
#include "schedules/model/cluster.h"
#include "sim/drives/scenario.h"

namespace ttf::cli::node_set {

// The options as written.
struct NodeSetArguments {
  std::string scenario;
  std::string strategy = "tt";
  std::optional<std::string> seed, time_scale, duration;
  std::string bus{live_media::kLiveMedia.front()->name};
  std::vector<std::string> cans;        // NAME=IF
  std::optional<std::string> external;  // NODE[,NODE]
  std::string session = "ttfusion";
  std::string truth;  // a trace in place of the scenario's objects
  std::string out;
  drive::StepOptions steps;
  bool virtual_time = false;
  bool no_topics = false;
  // For a node started by hand.
  std::optional<std::string> start_at;
  bool rejoin = false;
  std::optional<std::string> host;
};

void add_node_set_options(CLI::App& command, NodeSetArguments& arguments);

struct NodeSet {
  std::string file;                   // scenario or cluster, as given
  sim::drives::Scenario scenario;     // with the given duration and trace
  bool until_stopped = false;         // has the longest duration: a signal is the usual end; in real time only
  schedules::model::Cluster cluster;  // the strategy's, checked
  fusion::strategies::StrategyKind strategy{};
  std::uint64_t seed = 0;
  live_media::Bus bus;
  std::vector<std::string> can_interfaces;  // by Cluster::can_buses, if the medium has interfaces; else empty
  std::string session;                      // keeps out messages of other sessions
  std::vector<NodeId> externals;            // real nodes in the places of simulated ones; in real time only
  bool virtual_time = false;
  std::int64_t time_scale_ppm = 1'000'000;  // the factor from schedule to real time; always 1 in virtual time
  // The common start of all nodes without a supervisor, by CLOCK_REALTIME; in real time only.
  std::optional<std::int64_t> start_at_ns;
  std::string host;     // names the machine's clock in the node's log, for merging logs of several machines
  bool rejoin = false;  // begins cold and integrates into the running cluster; in real time only
  bool topics = true;   // publishes the drive for ROS 2; in real time only
  drive::StepOptions step_options;
  std::optional<nodes::foreign::StepFolder> steps;
  std::string folder;  // receives the nodes' logs: NAME.mcap (supervision::file_stem)

  // Returns whether its medium or its topics use DDS.
  bool needs_dds() const { return topics || bus.medium->needs_dds; }
  // Returns the options that give another process this very node set.
  std::vector<std::string> options() const;
};

// Reads a node set from a scenario or a cluster file. A cluster file drives the default scene: an
// accelerating car ahead. In real time the cluster must be fit for it at the time scale
// (schedules/check/real_time_rules.h), and faults are refused. The caller checks the
// steps of libraries, for the nodes that it runs. Throws InputError.
NodeSet read_node_set(const NodeSetArguments& arguments);

// Returns the node of this name, from an argument of the command line. Throws InputError with the argument, its text and
// all names otherwise.
NodeId node_of(const schedules::model::Cluster& cluster, const std::string& name, const std::string& argument,
               const std::string& text);

}  // namespace ttf::cli::node_set
