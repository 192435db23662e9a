// What must hold of a CAN interface before anything is sent on it, and the command that makes it so where it does not.
#pragma once

#include <string>

namespace ttf::socketcan {

// What the kernel says. Each member means something only if the ones before it hold.
struct InterfaceState {
  bool family = false;      // the kernel has CAN sockets (AF_CAN)
  bool raw = false;         // and raw ones (CAN_RAW)
  bool there = false;       // an interface of that name
  bool can = false;         // it is a CAN
  bool up = false;
  int mtu = 0;              // bytes: 16 classic CAN, 72 CAN FD
};

// Asks the kernel; changes nothing. Throws std::runtime_error where the kernel's answer is none of these.
InterfaceState interface_state(const std::string& name);

// What keeps that interface from being used, and the command that helps: one sentence, empty where there is nothing.
// With `flexible_data_rate` it must carry CAN FD.
std::string interface_problem(const std::string& name, const InterfaceState& state, bool flexible_data_rate);

}  // namespace ttf::socketcan
