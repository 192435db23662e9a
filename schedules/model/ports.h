// Binds a schedule's names to the code's, checked before anything runs. The errors are an unknown step, a needed
// port without binding, and a binding of an unknown port. A library's ports are those that the task binds: the library is
// not loaded here, and says for itself whether they suit it (nodes/foreign/ttfusion_step.h).
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <initializer_list>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "schedules/model/cluster.h"

namespace ttf::schedules::model {

// A few names of ports, as tables of steps have them; more of them do not compile.
class PortNames {
 public:
  constexpr PortNames() = default;
  constexpr PortNames(std::initializer_list<std::string_view> names) {
    for (const std::string_view name : names) names_.at(count_++) = name;
  }
  constexpr const std::string_view* begin() const { return names_.data(); }
  constexpr const std::string_view* end() const { return names_.data() + count_; }
  constexpr bool empty() const { return count_ == 0; }
  constexpr bool contains(std::string_view name) const { return std::find(begin(), end(), name) != end(); }

 private:
  std::array<std::string_view, 4> names_{};
  std::size_t count_ = 0;
};

// The ports that the code of one step reads and writes.
struct StepPorts {
  std::string_view step;
  PortNames reads = {};
  PortNames writes = {};
  bool any_reads =
      false;  // besides `reads`, the step reads at least one sensor's list, by a port with that sensor's name
  PortNames may_read = {};  // ports that a task may leave out
  // It writes sensors' lists, too, each at the port written_port() of its sensor.
  bool any_writes = false;
  PortNames may_write = {};
};

// Returns the port by which a step with any_writes writes the lists of a sensor: camera_objects for the sensor camera.
std::string written_port(std::string_view sensor);

// Returns the ports at which the task reads a list whose counterpart it writes, in order: the cameras of a detector.
std::vector<const PortBinding*> camera_ports(const Task& task);

// Returns whether a step's name is a library's file name, such as distance.so, and not that of the program's own code.
bool names_library(std::string_view step);

// Throws InputError with every mismatch.
void bind_ports(const Cluster& cluster, std::span<const StepPorts> steps);

}  // namespace ttf::schedules::model
