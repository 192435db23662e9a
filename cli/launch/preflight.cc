#include "cli/launch/preflight.h"

#include <fmt/format.h>
#include <linux/can.h>
#include <net/if.h>
#include <net/if_arp.h>
#include <sys/ioctl.h>
#include <sys/socket.h>

#include <algorithm>
#include <cctype>
#include <cstring>
#include <optional>

#include "cli/launch/descriptor.h"
#include "cli/launch/lines.h"
#include "core/errors.h"

namespace ttf::launch {
namespace {

constexpr std::string_view kBusExpected =
    "must be dds, or socketcan: with one or two different interfaces, as in socketcan:vcan0,vcan1";

// As the kernel takes it (dev_valid_name): up to 15 bytes, no '/', ':' or white space, and neither "." nor "..".
bool is_interface_name(std::string_view name) {
  return !name.empty() && name.size() < IFNAMSIZ && name != "." && name != ".." &&
         std::ranges::none_of(name, [](char c) {
           return c == '/' || c == ':' || c == ',' || std::isspace(static_cast<unsigned char>(c)) != 0 ||
                  static_cast<unsigned char>(c) < 0x20;
         });
}

// What the kernel says of an interface; nothing where it is not there.
struct Link {
  int hardware = 0;   // ARPHRD_...
  int mtu = 0;
  bool up = false;
};

std::optional<Link> link_of(const std::string& name) {
  const Descriptor any(socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0));   // any socket answers
  const auto ask = [&](unsigned long question, ifreq& answer) {
    answer = {};
    name.copy(answer.ifr_name, IFNAMSIZ - 1);
    return ioctl(any.get(), question, &answer) == 0;
  };
  ifreq answer{};
  Link link;
  if (!ask(SIOCGIFHWADDR, answer)) return std::nullopt;
  link.hardware = answer.ifr_hwaddr.sa_family;
  if (!ask(SIOCGIFMTU, answer)) return std::nullopt;
  link.mtu = answer.ifr_mtu;
  if (!ask(SIOCGIFFLAGS, answer)) return std::nullopt;
  link.up = (answer.ifr_flags & IFF_UP) != 0;
  return link;
}

PreflightItem look_at_loopback() {
  const auto link = link_of("lo");
  if (!link) return {"lo", false, "is not there: DDS has no loopback interface to run over", {}};
  if (!link->up) return {"lo", false, "is down: DDS runs over loopback", {"ip link set lo up"}};
  return {"lo", true, "is up: DDS runs over loopback", {}};
}

PreflightItem look_at_can(const std::string& name, std::string_view channel) {
  const std::string mtu = fmt::format("ip link set {} mtu {}", name, CANFD_MTU),
                    up = fmt::format("ip link set {} up", name);
  const auto link = link_of(name);
  if (!link) {
    if (!name.starts_with("vcan")) return {name, false, fmt::format("is not there (channel {})", channel), {}};
    return {name, false, fmt::format("is not there (channel {})", channel),
            {"modprobe vcan", fmt::format("ip link add dev {} type vcan", name), mtu, up}};
  }
  if (link->hardware != ARPHRD_CAN) return {name, false, fmt::format("is no CAN interface (channel {})", channel), {}};
  PreflightItem item{name, true, fmt::format("is a CAN FD interface and up (channel {})", channel), {}};
  if (link->mtu < static_cast<int>(CANFD_MTU)) {
    item.how = fmt::format("takes no CAN FD frames: its MTU is {}, not {} (channel {})", link->mtu, CANFD_MTU, channel);
    if (link->up) item.commands.push_back(fmt::format("ip link set {} down", name));
    item.commands.push_back(mtu);
    item.commands.push_back(up);
  } else if (!link->up) {
    item.how = fmt::format("is down (channel {})", channel);
    item.commands.push_back(up);
  }
  item.good = item.commands.empty();
  return item;
}

PreflightItem look_at_can_sockets() {
  const Descriptor can(socket(PF_CAN, SOCK_RAW | SOCK_CLOEXEC, CAN_RAW));
  if (can.open()) return {"kernel", true, "has CAN sockets", {}};
  return {"kernel", false, fmt::format("has no CAN sockets: {}", std::strerror(errno)), {"modprobe can_raw"}};
}

}  // namespace

Bus Bus::parse(const std::string& text) {
  constexpr std::string_view kSocketCan = "socketcan:";
  if (text == "dds") return {};
  const auto refuse = [&]() { return InputError({"command line", 0, "--bus", text, std::string(kBusExpected)}); };
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

std::vector<PreflightItem> look_at(const Bus& bus) {
  if (bus.kind == BusKind::kDds) return {look_at_loopback()};
  std::vector<PreflightItem> items{look_at_can_sockets()};
  for (std::size_t i = 0; i < bus.interfaces.size(); ++i)
    items.push_back(look_at_can(bus.interfaces[i], i == 0 ? "A" : "B"));
  return items;
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

}  // namespace ttf::launch
