// The live media that --bus may name. One row has all facts of a medium for the rest of the program, which never asks
// for its kind. Each row is in a file of its own (dds.cc, socketcan.cc), which alone names the leaf.
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "bus/ports/listener.h"
#include "bus/ports/live_medium.h"
#include "cli/supervision/preflight.h"
#include "core/ids.h"
#include "schedules/model/cluster.h"

namespace ttf::cli::live_media {

// A CAN between sensors and hosts, if the medium has interfaces.
struct PrivateCan {
  std::string name;  // in the cluster file
  std::string interface;
  bool flexible_data_rate = false;  // it must carry CAN FD
};

// The setting of a node's medium: its channels and CANs.
struct MediumSetting {
  const schedules::model::Cluster& cluster;
  NodeId node{};
  // Interfaces, if the medium has any: of channel A and optionally of channel B; by Cluster::can_buses.
  const std::vector<std::string>& channel_interfaces;
  const std::vector<std::string>& can_interfaces;
  const std::string& session;                  // keeps out messages of other sessions
  std::chrono::milliseconds patience;          // the longest wait for others, if the medium must find them first
  const std::vector<NodeId>& real_nodes = {};  // not the program's own, and not waited for
};

// The setting of a listener, with the interfaces and the session of a MediumSetting.
struct ListenerSetting {
  const schedules::model::Cluster& cluster;
  const std::vector<std::string>& channel_interfaces;
  const std::vector<std::string>& can_interfaces;
  const std::string& session;
  const bus::ports::ReceivedIdentifiers& identifiers;
};

// How a node's frames travel on a medium without interfaces: each as a sample with fields, in words.
struct Carriage {
  struct Field {
    std::string name, type;
    std::string of_slot, on_can;  // its value in a frame of a slot, and in one of a private CAN
  };
  std::vector<std::string> places;  // by bus::ports::Line: "ttf/flexray/A"
  // The common properties: {"partition", "ttfusion"}.
  std::vector<std::pair<std::string, std::string>> properties;
  std::vector<Field> fields;
};

struct LiveMediumRow {
  std::string_view name;         // in --bus, before its interfaces: "socketcan"
  std::string_view form;         // the whole value: "socketcan:IF[,IF]"
  std::string_view form_help;    // after the form in --help: " with the interfaces of channels A and B"
  std::string_view expectation;  // the requirement of --bus, in the words of a Finding
  // The number of interfaces in --bus, channel A first. With 0 at most, private CANs have no interfaces either.
  std::size_t least_interfaces = 0, most_interfaces = 0;
  std::string_view not_in_virtual_time;  // the reason why it cannot carry an exchange; empty: it can
  bool needs_dds = false;                // Cyclone DDS must run with its configuration
  // The checks before a launch, and an alternative for a failed check (may be empty).
  std::vector<supervision::PreflightItem> (*look_at)(const std::vector<std::string>& channel_interfaces,
                                                     const std::vector<PrivateCan>& cans) = nullptr;
  std::string_view way_out;
  // Warns of missing resources. Throws InputError if the setting names a missing interface,
  // std::runtime_error if the medium does not start.
  std::unique_ptr<bus::ports::LiveMedium> (*make)(const MediumSetting& setting) = nullptr;

  // Makes a listener for nodes that are not the program's own. Throws as `make`.
  std::unique_ptr<bus::ports::Listener> (*listen)(const ListenerSetting& setting) = nullptr;
  // Returns how the frames of a node travel; null for a medium with interfaces, which carry them as they are.
  Carriage (*carriage)(const schedules::model::Cluster& cluster, NodeId node, const std::string& session) = nullptr;

  bool has_interfaces() const { return most_interfaces > 0; }
};

// dds.cc, socketcan.cc
extern const LiveMediumRow kDds, kSocketCan;

// The first is the default. A build may leave DDS out (TTF_WITH_DDS), and with it virtual time over several processes and
// ROS 2's topics.
#ifndef TTF_WITH_DDS
#error "ttf_live_media's users have TTF_WITH_DDS from it"
#endif
#if TTF_WITH_DDS
inline constexpr bool kWithDds = true;
inline constexpr std::array kLiveMedia{&kDds, &kSocketCan};
#else
inline constexpr bool kWithDds = false;
inline constexpr std::array kLiveMedia{&kSocketCan};
#endif

}  // namespace ttf::cli::live_media
