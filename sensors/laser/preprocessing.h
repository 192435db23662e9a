// The host's preprocessing of a laser's scans.
#pragma once

#include <array>
#include <vector>

#include "sensors/laser/preprocessor.h"
#include "sensors/preprocessing.h"

namespace ttf::sensors::laser {

// Ports: `raw` (layer, azimuth, range) -> `objects` (the seen point, heading, extent and their uncertainty).
class LaserPreprocessing final : public Preprocessing {
 public:
  LaserPreprocessing(const schedules::model::Cluster& cluster, const schedules::model::Task& task,
                     const LaserPreprocessingConfig& config);

 private:
  void process(nodes::host::StepContext& context, const nodes::host::Strobe& measurement) override;

  std::array<std::size_t, 3> raw_;
  std::array<std::size_t, 12> signals_;
  std::size_t raw_room_;  // a list of so many returns is full
  LaserPreprocessor preprocessor_;
  std::vector<ScanPoint> points_;
  std::vector<LaserObject> objects_;
};

}  // namespace ttf::sensors::laser
