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

namespace ttf::socketcan {
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
  const Descriptor socket(::socket(PF_CAN, SOCK_RAW | SOCK_CLOEXEC, CAN_RAW));
  if (socket.value() < 0) {
    if (errno != EAFNOSUPPORT && errno != EPROTONOSUPPORT) unexpected(name, "no CAN socket");
    state.family = errno == EPROTONOSUPPORT;
    return state;
  }
  state.family = state.raw = true;
  ifreq request{};
  if (name.empty() || name.size() >= sizeof request.ifr_name || name.find('\0') != std::string::npos) return state;
  std::memcpy(request.ifr_name, name.data(), name.size());
  if (ioctl(socket.value(), SIOCGIFHWADDR, &request) != 0) {
    if (errno != ENODEV) unexpected(name, "no answer about its kind");
    return state;
  }
  state.there = true;
  state.can = request.ifr_hwaddr.sa_family == ARPHRD_CAN;
  if (ioctl(socket.value(), SIOCGIFFLAGS, &request) != 0) unexpected(name, "no answer about its flags");
  state.up = (static_cast<unsigned short>(request.ifr_flags) & IFF_UP) != 0;
  if (ioctl(socket.value(), SIOCGIFMTU, &request) != 0) unexpected(name, "no answer about its MTU");
  state.mtu = request.ifr_mtu;
  return state;
}

std::string interface_problem(const std::string& name, const InterfaceState& state, bool flexible_data_rate) {
  if (!state.family)
    return "this kernel has no CAN sockets (AF_CAN): modprobe can_raw && modprobe vcan, in a container on its host";
  if (!state.raw) return "this kernel has no raw CAN sockets (CAN_RAW): modprobe can_raw, in a container on its host";
  if (!state.there) {
    if (name.empty() || name.size() >= IFNAMSIZ)
      return fmt::format("interfaces have names of 1..{} bytes", IFNAMSIZ - 1);
    if (is_virtual(name))
      return fmt::format("no such interface: ip link add dev {} type {} && {}", name, name[1] == 'x' ? "vxcan" : "vcan",
                         bring_up(name, flexible_data_rate));
    return "no such interface: ip -details link show type can lists those there are";
  }
  if (!state.can) return "not a CAN interface: ip -details link show type can lists those there are";
  const bool narrow = flexible_data_rate && state.mtu < static_cast<int>(CANFD_MTU);
  if (narrow)
    return fmt::format("carries no CAN FD frames (MTU {}, needs {}): {}{}", state.mtu, CANFD_MTU,
                       state.up ? fmt::format("ip link set {} down && ", name) : "", bring_up(name, true));
  if (!state.up) return fmt::format("not up: {}", bring_up(name, flexible_data_rate));
  return "";
}

}  // namespace ttf::socketcan
