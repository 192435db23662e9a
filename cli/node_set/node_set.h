// The node set of a launch: what `launch` and `node` are both told on the command line, read and checked once, and told
// on.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "cli/live_media/bus.h"
#include "core/time.h"
#include "drives/scenario.h"
#include "fusion/strategies/strategy.h"
#include "schedules/model/cluster.h"

namespace ttf::cli::node_set {

// As written.
struct NodeSetArguments {
  std::string scenario;
  std::string strategy = "tt";
  std::optional<std::string> seed, time_scale, duration;
  std::string bus{live_media::kLiveMedia.front()->name};
  std::vector<std::string> cans;  // NAME=IF
  std::string session = "ttfusion";
  std::string out;
  bool virtual_time = false;
  bool no_topics = false;
  // Of a node that is started by hand.
  std::optional<std::string> start_at;
  bool rejoin = false;
  std::optional<std::string> host;
};

void add_node_set_options(CLI::App& command, NodeSetArguments& arguments);

struct NodeSet {
  std::string file;                   // scenario or cluster, as given
  drives::Scenario scenario;          // with the duration asked for
  schedules::model::Cluster cluster;  // of the strategy, checked
  fusion::strategies::StrategyKind strategy{};
  std::uint64_t seed = 0;
  live_media::Bus bus;
  std::vector<std::string> can_interfaces;  // by Cluster::can_buses, where the medium has any; else empty
  std::string session;                      // who is in another one is not heard
  bool virtual_time = false;
  std::int64_t time_scale_ppm = 1'000'000;  // the schedule lasts so much longer in real time; in virtual time always 1
  // The start that all nodes without a supervisor have in common, by CLOCK_REALTIME; in real time only.
  std::optional<std::int64_t> start_at_ns;
  std::string host;     // whose clock the node's log goes by, for the merge of several hosts' logs
  bool rejoin = false;  // begins cold and integrates into the cluster that runs; in real time only
  bool topics = true;   // in real time: what goes on is published for ROS 2
  std::string folder;   // where the nodes' logs go: NAME.mcap (launch::file_stem)

  // Its medium or its topics are DDS'.
  bool needs_dds() const { return topics || bus.medium->needs_dds; }
  // The options that make another process read this very node set.
  std::vector<std::string> options() const;
};

// In real time the cluster must be fit for it at the time scale (schedules/check/real_time_rules.h), and faults are
// refused. Given a cluster file instead of a scenario, the drive is the default scene: a car ahead that accelerates.
// Throws InputError.
NodeSet read_node_set(const NodeSetArguments& arguments);

// The node of this name, or InputError that lists the names.
NodeId node_of(const schedules::model::Cluster& cluster, const std::string& name);

}  // namespace ttf::cli::node_set
