// The live media that --bus may name: one row says all that the program needs to know of each. Each row is in a file of
// its own (dds.cc, socketcan.cc), the one that names its leaf. Nobody else asks which medium it is.
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "bus/ports/live_medium.h"
#include "cli/supervision/preflight.h"
#include "core/ids.h"
#include "schedules/model/cluster.h"

namespace ttf::cli::live_media {

// A CAN between sensors and hosts, where the medium has interfaces.
struct PrivateCan {
  std::string name;  // in the cluster file
  std::string interface;
  bool flexible_data_rate = false;  // it must carry CAN FD
};

// What a medium is made of: the channels and CANs that the node is on.
struct MediumSetting {
  const schedules::model::Cluster& cluster;
  NodeId node{};
  // Of a medium that has them: of channel A, and of channel B unless it is left out; by Cluster::can_buses.
  const std::vector<std::string>& channel_interfaces;
  const std::vector<std::string>& can_interfaces;
  const std::string& session;          // who is in another one is not heard
  std::chrono::milliseconds patience;  // where nobody is heard at once: so long the others are waited for at most
};

struct LiveMediumRow {
  std::string_view name;         // in --bus, before its interfaces: "socketcan"
  std::string_view form;         // all of it: "socketcan:IF[,IF]"
  std::string_view form_help;    // behind the form in --help: " with the interfaces of channels A and B"
  std::string_view expectation;  // what --bus must be, in the words of a Finding
  // How many interfaces --bus names, of channel A first; with 0 at most the medium has none, and private CANs neither.
  std::size_t least_interfaces = 0, most_interfaces = 0;
  std::string_view not_in_virtual_time;  // why it cannot carry an exchange; empty: it can
  bool needs_dds = false;                // Cyclone DDS must be able to run with its configuration
  // What a launch looks at before it starts anything, and what helps besides where that is not all well: maybe nothing.
  std::vector<supervision::PreflightItem> (*look_at)(const std::vector<std::string>& channel_interfaces,
                                                     const std::vector<PrivateCan>& cans) = nullptr;
  std::string_view way_out;
  // Warns of what it goes on without. Throws InputError where what the setting names is not there, std::runtime_error
  // where the medium does not start.
  std::unique_ptr<bus::ports::LiveMedium> (*make)(const MediumSetting& setting) = nullptr;

  bool has_interfaces() const { return most_interfaces > 0; }
};

// dds.cc, socketcan.cc
extern const LiveMediumRow kDds, kSocketCan;

// The first is the default.
inline constexpr std::array kLiveMedia{&kDds, &kSocketCan};

}  // namespace ttf::cli::live_media
