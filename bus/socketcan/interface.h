// The requirements on a kernel and a CAN interface before anything is sent, and the commands that meet them.
// Sockets state them in one sentence; the preflight check of a launch shows them one by one.
#pragma once

#include <string>
#include <vector>

namespace ttf::bus::socketcan {

// The kernel's answers; the interface's state is known even without CAN sockets.
struct InterfaceState {
  int refused = 0;     // errno of the refused raw CAN socket; 0: granted
  bool there = false;  // the interface exists; all below is valid only then
  bool can = false;    // it is a CAN interface
  bool up = false;
  int mtu = 0;  // bytes: 16 classic CAN, 72 CAN FD
};

// Asks the kernel and changes nothing. Throws std::runtime_error if the kernel does not describe a known interface.
InterfaceState interface_state(const std::string& name);

// A fault, and the known commands that mend it, in order and as root.
struct Problem {
  std::string what;  // a predicate, "is not there"; empty: no fault
  std::vector<std::string> commands;

  explicit operator bool() const { return !what.empty(); }
  std::string text() const;  // with the commands as one would type them
};
// Returns a fault of the kernel: "has no CAN sockets".
Problem kernel_problem(const InterfaceState& state);
// Returns a fault of the interface alone. With `flexible_data_rate` it must carry CAN FD.
Problem link_problem(const std::string& name, const InterfaceState& state, bool flexible_data_rate);

// Returns the commands that make a virtual CAN of that name if the interface does not exist.
std::vector<std::string> virtual_interface(const std::string& name, bool flexible_data_rate);

// Returns the first fault of the kernel or else the interface, as text(): one sentence without the interface's
// name, empty without a fault.
std::string interface_problem(const std::string& name, const InterfaceState& state, bool flexible_data_rate);

}  // namespace ttf::bus::socketcan
