#include "bus/socketcan/interface.h"

#include <fmt/format.h>
#include <linux/can.h>
#include <net/if.h>
#include <net/if_arp.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <system_error>

namespace ttf::bus::socketcan {
namespace {

class Descriptor {
 public:
  explicit Descriptor(int value) : value_(value) {}
  ~Descriptor() {
    if (value_ >= 0) close(value_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int value() const { return value_; }

 private:
  int value_;
};

[[noreturn]] void unexpected(const std::string& name, const char* asked) {
  throw std::runtime_error(fmt::format("{}: {}: {}", name, asked, std::system_category().message(errno)));
}

bool is_virtual(const std::string& name) { return name.rfind("vcan", 0) == 0 || name.rfind("vxcan", 0) == 0; }

// 16 and 72: the sizes of the kernel's frame structures.
std::string bring_up(const std::string& name, bool flexible_data_rate) {
  if (is_virtual(name)) return fmt::format("ip link set {} mtu {} up", name, flexible_data_rate ? CANFD_MTU : CAN_MTU);
  return fmt::format("ip link set {} up type can bitrate {}", name,
                     flexible_data_rate ? "1000000 dbitrate 5000000 fd on" : "500000");
}

}  // namespace

InterfaceState interface_state(const std::string& name) {
  InterfaceState state;
  if (Descriptor(::socket(PF_CAN, SOCK_RAW | SOCK_CLOEXEC, CAN_RAW)).value() < 0) state.refused = errno;
  ifreq request{};
  if (name.empty() || name.size() >= sizeof request.ifr_name || name.find('\0') != std::string::npos) return state;
  std::memcpy(request.ifr_name, name.data(), name.size());
  const Descriptor any(::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0));  // any socket answers
  if (ioctl(any.value(), SIOCGIFHWADDR, &request) != 0) {
    if (errno != ENODEV) unexpected(name, "cannot read its kind");
    return state;
  }
  state.there = true;
  state.can = request.ifr_hwaddr.sa_family == ARPHRD_CAN;
  if (ioctl(any.value(), SIOCGIFFLAGS, &request) != 0) unexpected(name, "cannot read its flags");
  state.up = (static_cast<unsigned short>(request.ifr_flags) & IFF_UP) != 0;
  if (ioctl(any.value(), SIOCGIFMTU, &request) != 0) unexpected(name, "cannot read its MTU");
  state.mtu = request.ifr_mtu;
  return state;
}

Problem kernel_problem(const InterfaceState& state) {
  const char* const host = "a container uses its host's kernel";
  switch (state.refused) {
    case 0: return {};
    case EAFNOSUPPORT:
      return {fmt::format("has no CAN sockets (AF_CAN; {})", host), {"modprobe can_raw", "modprobe vcan"}};
    case EPROTONOSUPPORT: return {fmt::format("has no raw CAN sockets (CAN_RAW; {})", host), {"modprobe can_raw"}};
    default: return {fmt::format("gives no CAN socket: {}", std::system_category().message(state.refused)), {}};
  }
}

Problem link_problem(const std::string& name, const InterfaceState& state, bool flexible_data_rate) {
  const char* const others = "`ip -details link show type can` lists the CAN interfaces";
  if (!state.there) {
    if (name.empty() || name.size() >= IFNAMSIZ)
      return {fmt::format("is not an interface name: a name has 1..{} bytes", IFNAMSIZ - 1), {}};
    if (!is_virtual(name)) return {fmt::format("is not there; {}", others), {}};
    return {"is not there",
            {fmt::format("ip link add dev {} type {}", name, name[1] == 'x' ? "vxcan" : "vcan"),
             bring_up(name, flexible_data_rate)}};
  }
  if (!state.can) return {fmt::format("is not a CAN interface; {}", others), {}};
  if (flexible_data_rate && state.mtu < static_cast<int>(CANFD_MTU)) {
    Problem narrow{fmt::format("carries no CAN FD frames (MTU {}, needs {})", state.mtu, CANFD_MTU), {}};
    if (state.up) narrow.commands.push_back(fmt::format("ip link set {} down", name));
    narrow.commands.push_back(bring_up(name, true));
    return narrow;
  }
  if (!state.up) return {"is down", {bring_up(name, flexible_data_rate)}};
  return {};
}

std::vector<std::string> virtual_interface(const std::string& name, bool flexible_data_rate) {
  return {fmt::format("ip link add dev {} type vcan", name),
          fmt::format("ip link set {} mtu {} up", name, flexible_data_rate ? CANFD_MTU : CAN_MTU)};
}

std::string Problem::text() const {
  return commands.empty() ? what : fmt::format("{}: {}", what, fmt::join(commands, " && "));
}

std::string interface_problem(const std::string& name, const InterfaceState& state, bool flexible_data_rate) {
  if (const Problem kernel = kernel_problem(state)) return "the kernel " + kernel.text();
  return link_problem(name, state, flexible_data_rate).text();
}

}  // namespace ttf::bus::socketcan
