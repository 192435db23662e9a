// The host's preprocessing of a radar's returns.
#pragma once

#include <array>
#include <vector>

#include "sensors/preprocessing.h"
#include "sensors/radar/returns.h"

namespace ttf::sensors::radar {

// Ports: `raw` (range, azimuth, range_rate, power) -> `objects` (range, bearing, range_rate, their uncertainty, returns).
class RadarPreprocessing final : public Preprocessing {
 public:
  RadarPreprocessing(const schedules::model::Cluster& cluster, const schedules::model::Task& task,
                     const RadarPreprocessingConfig& config);

 private:
  void process(nodes::host::StepContext& context, const nodes::host::Strobe& measurement) override;

  std::array<std::size_t, 4> raw_;
  std::array<std::size_t, 7> signals_;
  ReturnJoiner joiner_;
  std::vector<Return> returns_;
  std::vector<RadarObject> objects_;
};

}  // namespace ttf::sensors::radar
