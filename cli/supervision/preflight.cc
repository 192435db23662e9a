#include "cli/supervision/preflight.h"

#include <fmt/format.h>
#include <net/if.h>

#include <algorithm>
#include <cctype>

#include "bus/socketcan/interface.h"
#include "cli/supervision/lines.h"
#include "core/errors.h"

namespace ttf::cli::supervision {
namespace {

constexpr std::string_view kBusExpected =
    "must be dds, or socketcan: with one or two different interfaces, as in socketcan:vcan0,vcan1";

PreflightItem look_at_loopback() {
  const bus::socketcan::InterfaceState lo = bus::socketcan::interface_state("lo");
  if (!lo.there) return {"lo", false, "is not there: DDS has no loopback interface to run over", {}};
  if (!lo.up) return {"lo", false, "is down: DDS runs over loopback", {"ip link set lo up"}};
  return {"lo", true, "is up: DDS runs over loopback", {}};
}

// An interface, and who it is for.
struct User {
  std::string interface, who;  // "vcan0", "channel A"
  bool flexible_data_rate = false;
  bool by_own_name = false;  // a CAN's: no name that hardware has, so that a virtual one is meant
};

std::vector<User> users_of(const Bus& bus, const std::vector<PrivateCan>& cans) {
  std::vector<User> users;
  for (std::size_t i = 0; i < bus.interfaces.size(); ++i)
    users.push_back({bus.interfaces[i], fmt::format("channel {}", "AB"[i]), true, false});
  for (const PrivateCan& can : cans)
    users.push_back({can.interface, can.name, can.flexible_data_rate, can.interface == can.name});
  return users;
}

// What the kernel and the interfaces lack, and what helps, the medium itself knows.
std::vector<PreflightItem> look_at_can(const std::vector<User>& users) {
  std::vector<PreflightItem> items;
  for (const User& user : users) {
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

}  // namespace

bool is_interface_name(std::string_view name) {
  return !name.empty() && name.size() < IFNAMSIZ && name != "." && name != ".." &&
         std::ranges::none_of(name, [](char c) {
           return c == '/' || c == ':' || c == ',' || std::isspace(static_cast<unsigned char>(c)) != 0 ||
                  static_cast<unsigned char>(c) < 0x20;
         });
}

Bus Bus::parse(const std::string& text) {
  constexpr std::string_view kSocketCan = "socketcan:";
  if (text == "dds") return {};
  const auto refuse = [&]() {
    return InputError({"command line", 0, "--bus", text, fmt::format("{} (each {})", kBusExpected, kInterfaceNames)});
  };
  if (!text.starts_with(kSocketCan)) throw refuse();
  Bus bus{BusKind::kSocketCan, {}};
  const std::string list = text.substr(kSocketCan.size());
  const std::size_t comma = list.find(',');
  bus.interfaces.push_back(list.substr(0, comma));
  if (comma != std::string::npos) bus.interfaces.push_back(list.substr(comma + 1));
  if (!std::ranges::all_of(bus.interfaces, is_interface_name) ||
      bus.interfaces.front() == (comma == std::string::npos ? "" : bus.interfaces.back()))
    throw refuse();
  return bus;
}

std::string Bus::text() const {
  return kind == BusKind::kDds ? "dds" : fmt::format("socketcan:{}", fmt::join(interfaces, ","));
}

std::vector<PreflightItem> look_at(const Bus& bus, const std::vector<PrivateCan>& cans) {
  return bus.kind == BusKind::kDds ? std::vector{look_at_loopback()} : look_at_can(users_of(bus, cans));
}

bool all_good(const std::vector<PreflightItem>& items) {
  return std::ranges::all_of(items, [](const PreflightItem& item) { return item.good; });
}

std::string text_of(const std::vector<PreflightItem>& items) {
  std::string text;
  for (const PreflightItem& item : items) {
    text += fmt::format("{}: {} {}{}\n", item.good ? "ok" : "not ready", printable(item.what), printable(item.how),
                        item.commands.empty() ? "" : "; as root:");
    for (const std::string& command : item.commands) text += fmt::format("    {}\n", printable(command));
  }
  return text;
}

nlohmann::ordered_json json_of(const std::vector<PreflightItem>& items) {
  auto list = nlohmann::ordered_json::array();
  for (const PreflightItem& item : items)
    list.push_back({{"what", item.what}, {"good", item.good}, {"how", item.how}, {"commands", item.commands}});
  return list;
}

}  // namespace ttf::cli::supervision
