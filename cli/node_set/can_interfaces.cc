#include "cli/node_set/can_interfaces.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "core/errors.h"

namespace ttf::cli::node_set {
namespace {

InputError refused(const std::string& option, std::string expected) {
  return InputError({"command line", 0, "--can", option, std::move(expected)});
}

// Returns the interface of each CAN.
std::map<std::string, std::string> interfaces_by_name(const schedules::model::Cluster& cluster,
                                                      const std::vector<std::string>& given) {
  std::map<std::string, std::string> named;
  for (const std::string& option : given) {
    const std::size_t sign = option.rfind('=');
    const std::string interface = sign == std::string::npos ? "" : option.substr(sign + 1);
    if (!live_media::is_interface_name(interface))
      throw refused(option, fmt::format("must be NAME=IF, a CAN of {} and its interface ({})", cluster.file,
                                        live_media::kInterfaceNames));
    const std::string name = option.substr(0, sign);
    if (std::ranges::find(cluster.can_buses, name, &schedules::model::CanBus::name) == cluster.can_buses.end()) {
      std::vector<std::string> names;
      for (const schedules::model::CanBus& bus : cluster.can_buses) names.push_back(bus.name);
      throw refused(option, names.empty()
                                ? fmt::format("must not be given: {} has no CAN", cluster.file)
                                : fmt::format("must name a CAN of {}: {}", cluster.file, fmt::join(names, ", ")));
    }
    if (!named.emplace(name, interface).second) throw refused(option, "must be given once for each CAN");
  }
  return named;
}

}  // namespace

std::vector<std::string> can_interfaces(const schedules::model::Cluster& cluster, const live_media::Bus& bus,
                                        const std::vector<std::string>& given) {
  if (!bus.medium->has_interfaces()) {
    if (!given.empty())
      throw refused(given.front(),
                    fmt::format("goes with --bus {} only: other buses have no interfaces for private CANs",
                                live_media::forms_with_interfaces()));
    return {};
  }
  const auto named = interfaces_by_name(cluster, given);
  std::map<std::string, std::string> users;  // by interface
  for (std::size_t channel = 0; channel < bus.interfaces.size(); ++channel)
    users[bus.interfaces[channel]] = fmt::format("channel {}", "AB"[channel]);
  std::vector<std::string> interfaces;
  for (const schedules::model::CanBus& can : cluster.can_buses) {
    const auto own = named.find(can.name);
    const std::string interface = own == named.end() ? can.name : own->second;
    if (!live_media::is_interface_name(interface))
      throw InputError(
          cluster.finding(can.line, fmt::format("can.{}", can.name), "",
                          fmt::format("needs --can NAME=IF on SocketCAN, as its name cannot be an interface's ({})",
                                      live_media::kInterfaceNames)));
    if (const auto [user, only] = users.emplace(interface, can.name); !only)
      throw refused(fmt::format("{}={}", can.name, interface),
                    fmt::format("must differ from the interface of {}", user->second));
    interfaces.push_back(interface);
  }
  return interfaces;
}

std::vector<std::string> can_options(const schedules::model::Cluster& cluster,
                                     const std::vector<std::string>& interfaces) {
  std::vector<std::string> options;
  for (std::size_t i = 0; i < interfaces.size(); ++i)
    options.insert(options.end(), {"--can", fmt::format("{}={}", cluster.can_buses[i].name, interfaces[i])});
  return options;
}

std::vector<live_media::PrivateCan> private_cans(const schedules::model::Cluster& cluster,
                                                 const std::vector<std::string>& interfaces) {
  std::vector<live_media::PrivateCan> cans;
  for (std::size_t i = 0; i < interfaces.size(); ++i)
    cans.push_back({cluster.can_buses[i].name, interfaces[i], cluster.can_buses[i].flexible_data_rate});
  return cans;
}

}  // namespace ttf::cli::node_set
