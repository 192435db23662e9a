// The meaning of every key, in one sentence, and an example where the default does not show one. A test finds keys
// without a description and descriptions without a key.
#pragma once

#include <span>
#include <string_view>

namespace ttf::keys {

struct Description {
  std::string_view key;  // its path below the place of the chapter
  std::string_view meaning;
  std::string_view example = "";
  std::string_view when = "";  // "mode=cas": only where this holds; such rows go before the general one
};
using Descriptions = std::span<const Description>;

// The keys of a kind's sensors, and those of their preprocessing.
struct KindDescriptions {
  std::string_view word;  // in files, the kind's
  Descriptions sensor, preprocessing;
};

Descriptions scenario_descriptions();
Descriptions sensor_descriptions();                     // below a sensor of a scenario, whatever its kind
std::span<const KindDescriptions> kind_descriptions();  // the first kind says the meaning of a key that several have
Descriptions laser_preprocessing_descriptions();
Descriptions ego_descriptions();            // below `world.ego`
Descriptions road_descriptions();           // below `world.road`
Descriptions traffic_light_descriptions();  // below `world.traffic_lights[]`
Descriptions size_descriptions();
Descriptions mounting_descriptions();
Descriptions tracker_descriptions();
Descriptions known_sensor_descriptions();  // below a sensor of the tracker's
Descriptions fault_descriptions();         // below `faults[]`
Descriptions fault_list_descriptions();
Descriptions cluster_descriptions();
Descriptions cluster_parameter_descriptions();  // below `flexray`
Descriptions node_parameter_descriptions();     // below `flexray` of a node, and `node_parameters`
Descriptions plan_descriptions();
Descriptions experiment_descriptions();
Descriptions track_descriptions();

}  // namespace ttf::keys
