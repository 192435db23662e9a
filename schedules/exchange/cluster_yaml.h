// Writes a cluster as a cluster file (schedules/file/loader.h), with every value said.
#pragma once

#include <string>

#include "schedules/model/cluster.h"

namespace ttf::schedules::exchange {

// Returns the text; `heading` is its comment, of any number of lines. Read again, it is the same cluster,
// with another file, other lines and this text. Values that all controllers share are in node_parameters.
std::string cluster_yaml(const model::Cluster& cluster, const std::string& heading);

}  // namespace ttf::schedules::exchange
