// The parameters of faults, each read from a plan and written into one: keys, units and ranges are here and nowhere
// else.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/strict_yaml.h"
#include "core/time.h"
#include "faults/plan.h"
#include "schedules/model/cluster.h"

namespace ttf::faults {

// All parameters that the fault has are read, or written, in its kind's order. `latest`: the largest `from` that makes
// sense.
void read_parameters(YamlMap& yaml, Fault& fault, Duration latest);
void write_parameters(const Fault& fault, const schedules::model::Cluster& cluster,
                      std::vector<std::pair<std::string_view, std::string>>& keys);

}  // namespace ttf::faults
