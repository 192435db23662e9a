#include "sensors/radar/preprocessing.h"

#include <algorithm>

namespace ttf::sensors::radar {

RadarPreprocessing::RadarPreprocessing(const schedules::model::Cluster& cluster, const schedules::model::Task& task,
                                       const RadarPreprocessingConfig& config)
    : Preprocessing(cluster, task), raw_(nodes::host::bind_element<4>(cluster, layout_read(cluster, task, "raw"),
                                                                      {"range", "azimuth", "range_rate", "power"})),
      signals_(nodes::host::bind_element<7>(
          cluster, layout_written(cluster, task, "objects"),
          {"range", "bearing", "range_rate", "sigma_range", "sigma_bearing", "sigma_range_rate", "returns"})),
      joiner_(config, static_cast<std::size_t>(layout_read(cluster, task, "raw").max_elements)) {
  returns_.reserve(static_cast<std::size_t>(layout_read(cluster, task, "raw").max_elements));
  objects_.reserve(static_cast<std::size_t>(layout_read(cluster, task, "raw").max_elements));
}

// The joiner's objects are by range: the nearest ones stay. More returns than the layout can say count as many as it can.
void RadarPreprocessing::process(nodes::host::StepContext& context, const nodes::host::Strobe& measurement) {
  returns_.clear();
  read_list(context.inputs[0], raw_, [&](const std::array<double, 4>& values) {
    returns_.push_back({values[0], values[1], values[2]});
  });
  joiner_.join(returns_, objects_);
  nodes::host::Output& out = context.outputs[0];
  const int listed = std::min(static_cast<int>(objects_.size()), out.layout().max_elements);
  out.begin(measurement.sequence, listed, measurement.at);
  for (int i = 0; i < listed; ++i) {
    const RadarObject& object = objects_[static_cast<std::size_t>(i)];
    const double values[] = {object.range, object.bearing, object.range_rate};
    const double sigmas[] = {object.sigma_range, object.sigma_bearing, object.sigma_range_rate};
    for (std::size_t s = 0; s < 3; ++s) out.set(i, signals_[s], values[s]);
    for (std::size_t s = 0; s < 3; ++s) out.set_at_least(i, signals_[3 + s], sigmas[s]);
    out.set(i, signals_[6], std::min<double>(object.returns, out.layout().element[signals_[6]].high));
  }
}

}  // namespace ttf::sensors::radar
