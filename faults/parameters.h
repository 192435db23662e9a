// Reads the parameters of faults from a plan and writes them: the only place of their keys, units and ranges.
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

// Read or write all parameters of the fault, in its kind's order. `latest` is the largest permitted `from`. `time_text`
// writes times.
void read_parameters(YamlMap& yaml, Fault& fault, Duration latest);
void write_parameters(const Fault& fault, const schedules::model::Cluster& cluster, std::string (*time_text)(Duration),
                      std::vector<std::pair<std::string_view, std::string>>& keys);

}  // namespace ttf::faults
