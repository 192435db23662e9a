// A sensor that is like another one, with a device and a host of its own.
//
// The copy has lists, CANs and slots, named alike: rear_laser's host is rear_laser_pre if the laser's is laser_pre. A CAN that
// carries lists of others, too, carries the copy's lists as well. A task that takes and sends lists of the sensor alone is
// copied: the gateway's, or the one that fuses them. Where one task fuses the lists of several sensors it reads the new one's, too.
// The copy's host has the next free key slot, and is neither a sync nor a startup node. Its slots, deadlines and the instants of
// its tasks are left out, and so are the repetitions that the sensor's tasks and lists leave out.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/strict_yaml.h"
#include "schedules/left_out/parts.h"
#include "schedules/model/cluster.h"

namespace ttf::schedules::file::likeness {

// The differences from the sensor `from`. Another kind has its own steps and layouts (layouts.h).
struct SensorCopy {
  SensorId from{};
  std::string name;
  model::SensorKind kind{};
  std::optional<int> raw, objects;        // most elements of the lists that the device and the host send
  std::optional<Duration> preprocessing;  // longest execution of the host's task
  int line = 0;
};

// Reads the keys `raw`, `objects` and `preprocessing`.
void read_differences(YamlMap& map, SensorCopy& copy);

// The cluster, and the parts that its file leaves out.
struct Unfinished {
  model::Cluster& cluster;
  std::vector<std::vector<left_out::TaskParts>>& tasks;
  std::vector<left_out::List>& lists;
  std::vector<std::vector<bool>>& shortest_periods;
};

// The key that forbids a copy, and its sentence.
struct Refusal {
  std::string key, expected;
};
// Returns nothing if the sensor can be copied.
std::optional<Refusal> refusal(const Unfinished& schedule, const SensorCopy& copy);

// Return the paths of the copy's own parts, as "nodes.rear_pre", and the sentence that refuses them in a file: a file has all parts
// of a sensor or none.
std::vector<std::string> parts_of(const Unfinished& schedule, const SensorCopy& copy);
std::string refusal_of_part(const std::string& sensor);

// Returns the names of the sensors that the copy may be of, as a list of words.
std::string originals(const model::Cluster& cluster, std::string_view copy);

// Gives the sensor `made` its device, its host and all that leads to the fusion. New nodes, PDUs, CANs and lists stand behind the
// others, the device before the host, the PDUs as those of the other sensor.
void copy_nodes(const Unfinished& schedule, const SensorCopy& copy, SensorId made);

}  // namespace ttf::schedules::file::likeness
