// Binds a schedule's names to the code's, checked before anything runs. The errors are an unknown step, a needed
// port without binding, and a binding of an unknown port.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "schedules/model/cluster.h"

namespace ttf::schedules::model {

// The ports that the code of one step reads and writes.
struct StepPorts {
  std::string_view step;
  std::vector<std::string_view> reads;
  std::vector<std::string_view> writes;
  bool any_reads = false;  // besides `reads`, the step reads at least one sensor's list, by a
                           // port with that sensor's name
};

// Throws InputError with every mismatch.
void bind_ports(const Cluster& cluster, std::span<const StepPorts> steps);

}  // namespace ttf::schedules::model
