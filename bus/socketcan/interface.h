// What must hold of a kernel and a CAN interface before anything is sent on it, and the commands that make it so where
// it does not. The one place that knows both: for sockets, which say it in a sentence, and for whoever looks at the bus
// before a launch.
#pragma once

#include <string>
#include <vector>

namespace ttf::bus::socketcan {

// What the kernel says; of the interface also where it has no CAN sockets.
struct InterfaceState {
  int refused = 0;     // why it gives no raw CAN socket, an errno; 0: it gives them
  bool there = false;  // an interface of that name; what follows means something only if this holds
  bool can = false;    // it is a CAN
  bool up = false;
  int mtu = 0;  // bytes: 16 classic CAN, 72 CAN FD
};

// Asks the kernel; changes nothing. Throws std::runtime_error where it knows an interface but tells nothing about it.
InterfaceState interface_state(const std::string& name);

// What is in the way, and the commands that help, one after the other and as root; none where none is known.
struct Problem {
  std::string what;  // a predicate, "is not there"; empty: all is well
  std::vector<std::string> commands;

  explicit operator bool() const { return !what.empty(); }
  std::string text() const;  // the commands behind it, as one would type them
};
// Of the kernel: "has no CAN sockets".
Problem kernel_problem(const InterfaceState& state);
// Of the interface alone. With `flexible_data_rate` it must carry CAN FD.
Problem link_problem(const std::string& name, const InterfaceState& state, bool flexible_data_rate);

// The commands that make a virtual CAN of that name, where there is no interface yet.
std::vector<std::string> virtual_interface(const std::string& name, bool flexible_data_rate);

// What keeps that interface from being used, the kernel first, as text(): one sentence without the interface's name,
// empty where there is nothing.
std::string interface_problem(const std::string& name, const InterfaceState& state, bool flexible_data_rate);

}  // namespace ttf::bus::socketcan
