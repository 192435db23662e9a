// Weather and light, as factors of each kind of sensor. Clear weather changes nothing. A kind's model applies them (sensors).
//
// | | rain | fog | dark | source |
// |---|---|---|---|---|
// | laser: range | 0.75 | 0.4 | 1 | assumed |
// | laser: lost echoes | 2 | 3 | 1 | assumed |
// | camera: range | 0.75 | 0.4 | 0.6 | assumed; the dark leaves the reach of headlamps |
// | camera: misses | 2 | 3 | 2 | assumed |
// | camera: false detections | 2 | 1 | 2 | assumed: spray, reflections, lamps |
// | radar: attenuation, one way | 6 dB/km | 0.2 dB/km | 0 | ITU-R P.838-3 at 77 GHz, 10 mm/h: 1.1 R^0.7; ITU-R P.840, 0.05 g/m^3 |
// | radar: false returns | 2 | 1 | 1 | assumed |
#pragma once

#include "core/strict_yaml.h"

namespace ttf::sim::world {

struct Weather {
  double laser_range = 1.0;    // factor of max_range
  double laser_misses = 1.0;   // factor of the lost echoes' part
  double camera_range = 1.0;   // as a laser's
  double camera_misses = 1.0;  // factor of the probability, at most 1
  double camera_clutter = 1.0;
  double radar_attenuation_db_per_km = 0.0;  // added
  double radar_clutter = 1.0;
};

// Reads `weather`: a name in the table above, or `clear`; and `weather_factors`, which replace single factors of it.
Weather load_weather(YamlMap& world);

}  // namespace ttf::sim::world
