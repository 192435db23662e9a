// Recorded scans of a laser scanner, as the scanner's host would treat them.
#pragma once

#include "core/strict_yaml.h"
#include "core/time.h"
#include "fusion/sensors/observation.h"
#include "recording/rows/scan_file.h"
#include "sensors/laser/preprocessor.h"

namespace ttf::sensors::laser {

// As YAML, with the keys of a scenario's preprocessing.laser:
//   {period: 100 ms, preprocessing: {range_noise: 0.03, azimuth_step: 0.00436}}
struct RecordedScansConfig {
  Duration period = Duration::milliseconds(100);  // from one frame to the next, in recordings without instants
  LaserPreprocessingConfig preprocessing;
  // A silhouette may be part of anything (fusion::sensors::Observation::weight); 1: it begins tracks as a car does.
  double silhouette_weight = 0.25;
};
RecordedScansConfig load_recorded_scans(YamlMap& yaml);

// Returns the instant of a scan: its own, or that of its frame.
GlobalTime instant_of(const recording::rows::RecordedScan& scan, const RecordedScansConfig& how);

// Returns the object as an observation in the scanner's axes, without the steps of a bus.
ttf::fusion::sensors::Observation observation_of(const LaserObject& object, const RecordedScansConfig& how);

}  // namespace ttf::sensors::laser
