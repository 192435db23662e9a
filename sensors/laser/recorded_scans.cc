#include "sensors/laser/recorded_scans.h"

#include <algorithm>

namespace ttf::sensors::laser {

RecordedScansConfig load_recorded_scans(YamlMap& yaml) {
  RecordedScansConfig config;
  config.period =
      yaml.duration_or("period", config.period, {Duration::microseconds(1), Duration::milliseconds(3'600'000)});
  config.silhouette_weight = yaml.number_or("silhouette_weight", config.silhouette_weight, {0.001, 1.0});
  if (std::optional<YamlMap> preprocessing = yaml.map_if("preprocessing")) {
    config.preprocessing = load_laser_preprocessing(*preprocessing);
    preprocessing->finish();
  }
  return config;
}

GlobalTime instant_of(const recording::rows::RecordedScan& scan, const RecordedScansConfig& how) {
  return GlobalTime{scan.time_ns ? *scan.time_ns : scan.frame * how.period.ns};
}

ttf::fusion::sensors::Observation observation_of(const LaserObject& object, const RecordedScansConfig& how) {
  ttf::fusion::sensors::Observation observation;
  observation.seen = object.seen;
  observation.z(0) = object.x;
  observation.z(1) = object.y;
  observation.r(0, 0) = object.sxx;
  observation.r(0, 1) = observation.r(1, 0) = object.sxy;
  observation.r(1, 1) = object.syy;
  observation.has_heading = object.has_heading;
  observation.has_length = object.has_length;
  observation.has_width = object.has_width;
  observation.heading = object.heading;
  observation.length = object.length;
  observation.width = object.width;
  observation.weight = object.shape == VehicleShape::kPart ? how.silhouette_weight : 1.0;
  // A certain value would be an error, as on a bus (sensors/observation_codec.cc).
  constexpr double kLeast = 1e-3;
  observation.sigma_heading = std::max(kLeast, object.sigma_heading);
  observation.sigma_length = std::max(kLeast, object.sigma_length);
  observation.sigma_width = std::max(kLeast, object.sigma_width);
  return observation;
}

}  // namespace ttf::sensors::laser
