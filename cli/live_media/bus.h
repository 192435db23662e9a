// --bus: a live medium and its interfaces.
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
  std::vector<std::string> interfaces;  // for channel A, and for channel B

  // Throws InputError with --bus.
  static Bus parse(const std::string& text);
  std::string text() const;
  // Returns whether the bus carries the channel: a medium with interfaces needs one for it.
  bool carries(schedules::model::Channel channel) const;
};

// Checks a name by the kernel's rule (dev_valid_name), and for --bus without commas: 1..15 bytes, no '/', ':'
// or white space, neither "." nor "..".
bool is_interface_name(std::string_view name);
inline constexpr const char* kInterfaceNames = "1..15 characters without white space, '/', ':' and ','";  // in words

// Returns the help text of --bus.
std::string bus_help();
// Returns the forms of --bus with interfaces for private CANs: "socketcan:IF[,IF]".
std::string forms_with_interfaces();

// Checks the interfaces of a bus, and of the private CANs if they have any, in the kernel's present state.
std::vector<supervision::PreflightItem> look_at(const Bus& bus, const std::vector<PrivateCan>& cans);

}  // namespace ttf::cli::live_media
