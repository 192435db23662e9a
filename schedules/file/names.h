// The names of a cluster file: any entry may refer to any other, so all names are known before the entries are read.
#pragma once

#include <fmt/format.h>

#include <optional>
#include <string_view>

#include "core/ids.h"
#include "core/strict_yaml.h"
#include "schedules/model/cluster.h"

namespace ttf::schedules::file {

class Names {
 public:
  // The cluster must outlive the object.
  explicit Names(const model::Cluster& cluster) : cluster_(cluster) {}

  // Return what the key names. An unknown name is a finding, and reads as the first one.
  NodeId node(YamlMap& map, std::string_view key) const {
    return reference(map, key, cluster_.find_node(map.text(key)), "node");
  }
  PduId pdu(YamlMap& map, std::string_view key) const {
    return reference(map, key, cluster_.find_pdu(map.text(key)), "PDU");
  }
  SensorId sensor(YamlMap& map, std::string_view key) const {
    return reference(map, key, cluster_.find_sensor(map.text(key)), "sensor");
  }

 private:
  template <class Id>
  static Id reference(YamlMap& map, std::string_view key, std::optional<Id> found, std::string_view what) {
    if (found) return *found;
    if (map.has(key)) map.fail(key, fmt::format("is not the name of a {} in this file", what));
    return Id{};
  }

  const model::Cluster& cluster_;
};

}  // namespace ttf::schedules::file
