// The live medium SocketCAN.
#include <fmt/format.h>

#include <array>

#include "bus/socketcan/interface.h"
#include "bus/socketcan/listener.h"
#include "bus/socketcan/medium.h"
#include "cli/live_media/live_media.h"
#include "cli/output.h"

namespace ttf::cli::live_media {
namespace {

// An interface and its user.
struct User {
  std::string interface, who;  // "vcan0", "channel A"
  bool flexible_data_rate = false;
  bool by_own_name = false;  // a CAN's own name, which no hardware has: the virtual interface is meant
};

std::vector<User> users_of(const std::vector<std::string>& channel_interfaces, const std::vector<PrivateCan>& cans) {
  std::vector<User> users;
  for (std::size_t i = 0; i < channel_interfaces.size(); ++i)
    users.push_back({channel_interfaces[i], fmt::format("channel {}", "AB"[i]), true, false});
  for (const PrivateCan& can : cans)
    users.push_back({can.interface, can.name, can.flexible_data_rate, can.interface == can.name});
  return users;
}

// The medium itself reports the errors of kernel and interfaces, and their remedies.
std::vector<supervision::PreflightItem> look_at_cans(const std::vector<std::string>& channel_interfaces,
                                                     const std::vector<PrivateCan>& cans) {
  std::vector<supervision::PreflightItem> items;
  for (const User& user : users_of(channel_interfaces, cans)) {
    const bus::socketcan::InterfaceState state = bus::socketcan::interface_state(user.interface);
    if (const auto kernel = bus::socketcan::kernel_problem(state); items.empty())
      items.push_back({"kernel", !kernel, kernel ? kernel.what : "has CAN sockets", kernel.commands});
    auto link = bus::socketcan::link_problem(user.interface, state, user.flexible_data_rate);
    if (link && !state.there && user.by_own_name)
      link = {"is not there", bus::socketcan::virtual_interface(user.interface, user.flexible_data_rate)};
    const char* const good = user.flexible_data_rate ? "is a CAN FD interface and up" : "is a CAN interface and up";
    items.push_back({user.interface, !link, fmt::format("{} ({})", link ? link.what : good, user.who), link.commands});
  }
  return items;
}

std::unique_ptr<bus::ports::LiveMedium> make_socketcan(const MediumSetting& setting) {
  const schedules::model::Node& node = setting.cluster.node(setting.node);
  bus::socketcan::LiveOptions options;
  for (const schedules::model::Channel channel : schedules::model::kBothChannels)
    if (node.flexray && includes(node.flexray->pChannels, channel) &&
        index_of(channel) < setting.channel_interfaces.size())
      options.channels[index_of(channel)] = setting.channel_interfaces[index_of(channel)];
  for (std::size_t b = 0; b < setting.cluster.can_buses.size(); ++b)
    options.cans.push_back({schedules::model::is_on_can(node, b) ? setting.can_interfaces[b] : "",
                            setting.cluster.can_buses[b].flexible_data_rate});
  auto medium = std::make_unique<bus::socketcan::SocketCanMedium>(options);
  print_warnings(medium->shortages());
  return medium;
}

std::unique_ptr<bus::ports::Listener> listen_to_cans(const ListenerSetting& setting) {
  std::array<std::string, 2> channels;
  for (std::size_t c = 0; c < setting.channel_interfaces.size(); ++c) channels[c] = setting.channel_interfaces[c];
  std::vector<bus::socketcan::SocketCanListener::Can> cans;
  for (std::size_t b = 0; b < setting.cluster.can_buses.size(); ++b)
    cans.push_back({setting.can_interfaces[b], setting.cluster.can_buses[b].flexible_data_rate});
  return std::make_unique<bus::socketcan::SocketCanListener>(channels, cans, setting.identifiers);
}

}  // namespace

const LiveMediumRow kSocketCan{
    .name = "socketcan",
    .form = "socketcan:IF[,IF]",
    .form_help = " with the interfaces of channels A and B",
    .expectation = "socketcan: with one or two different interfaces, as in socketcan:vcan0,vcan1",
    .least_interfaces = 1,
    .most_interfaces = 2,
    .not_in_virtual_time = "a CAN does not carry the nodes' promises to be silent",
    .needs_dds = false,
    .look_at = look_at_cans,
    .way_out = kWithDds ? "to do without CANs: --bus dds (the default); to have CANs without root: tools/test_bed.sh "
                          "(docs/media/socketcan.md)"
                        : "to have CANs without root: tools/test_bed.sh (docs/media/socketcan.md)",
    .make = make_socketcan,
    .listen = listen_to_cans,
    .carriage = nullptr,
};

}  // namespace ttf::cli::live_media
