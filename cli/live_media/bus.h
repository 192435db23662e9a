// --bus: a live medium, and the interfaces that it runs over.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "cli/live_media/live_media.h"
#include "cli/supervision/preflight.h"
#include "schedules/model/flexray_parameters.h"

namespace ttf::cli::live_media {

struct Bus {
  const LiveMediumRow* medium = kLiveMedia.front();
  std::vector<std::string> interfaces;  // of channel A, and of channel B

  // Throws InputError naming --bus.
  static Bus parse(const std::string& text);
  std::string text() const;
  // A medium that has interfaces has none for a channel that --bus names none for.
  bool carries(schedules::model::Channel channel) const;
};

// As the kernel takes it (dev_valid_name), and without the commas that --bus puts between two: 1..15 bytes, no '/', ':'
// or white space, and neither "." nor "..".
bool is_interface_name(std::string_view name);
inline constexpr const char* kInterfaceNames = "1..15 characters without white space, '/', ':' and ','";  // in words

// What --help says of --bus.
std::string bus_help();
// What --bus is where private CANs have interfaces: "socketcan:IF[,IF]".
std::string forms_with_interfaces();

// The interfaces that a bus runs over, and the private CANs' where it has some, as the kernel has them now.
std::vector<supervision::PreflightItem> look_at(const Bus& bus, const std::vector<PrivateCan>& cans);

}  // namespace ttf::cli::live_media
