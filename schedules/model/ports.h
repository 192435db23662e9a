// Binding of a schedule's names to the code's, checked both ways before anything runs: a step the code does not have, a
// port the code needs and the schedule does not bind, and a port the schedule binds and the code does not have.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "schedules/model/cluster.h"

namespace ttf::schedules::model {

// What the code of one step reads and writes.
struct StepPorts {
  std::string_view step;
  std::vector<std::string_view> reads;
  std::vector<std::string_view> writes;
  bool any_reads = false;  // besides `reads`, one port per sensor may be read, called like the sensor whose PDU it
                           // leads to; at least one
};

// Throws InputError with every mismatch.
void bind_ports(const Cluster& cluster, std::span<const StepPorts> steps);

}  // namespace ttf::schedules::model
