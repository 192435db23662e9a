// Binds a schedule's names to the code's, checked before anything runs. The errors are an unknown step, a needed
// port without binding, and a binding of an unknown port. A library's ports are those that the task binds: the library is
// not loaded here, and says for itself whether they suit it (nodes/foreign/ttfusion_step.h).
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "schedules/model/cluster.h"

namespace ttf::schedules::model {

// The ports that the code of one step reads and writes.
struct StepPorts {
  std::string_view step;
  std::vector<std::string_view> reads;
  std::vector<std::string_view> writes;
  bool any_reads = false;                       // besides `reads`, the step reads at least one sensor's list, by a
                                                // port with that sensor's name
  std::vector<std::string_view> may_read = {};  // ports that a task may leave out
  // It writes sensors' lists, too, each at the port written_port() of its sensor.
  bool any_writes = false;
  std::vector<std::string_view> may_write = {};
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
