#include "sensors/laser/preprocessing.h"

#include <cmath>

#include "sensors/nearest_first.h"
#include "sensors/observation_codec.h"

namespace ttf::sensors::laser {

LaserPreprocessing::LaserPreprocessing(const schedules::model::Cluster& cluster, const schedules::model::Task& task,
                                       const LaserPreprocessingConfig& config)
    : Preprocessing(cluster, task),
      raw_(nodes::host::bind_element<3>(cluster, layout_read(cluster, task, "raw"), {"layer", "azimuth", "range"})),
      signals_(nodes::host::bind_element<12>(cluster, layout_written(cluster, task, "objects"),
                                             {"x", "y", "heading", "length", "width", "sigma_x", "sigma_y",
                                              "correlation", "sigma_heading", "sigma_length", "sigma_width", "valid"})),
      raw_room_(static_cast<std::size_t>(layout_read(cluster, task, "raw").max_elements)),
      preprocessor_(config, raw_room_) {
  points_.reserve(raw_room_);
  objects_.reserve(preprocessor_.most_objects());
}

void LaserPreprocessing::process(nodes::host::StepContext& context, const nodes::host::Strobe& measurement) {
  points_.clear();
  read_list(context.inputs[0], raw_, [&](const std::array<double, 3>& values) {
    points_.push_back({static_cast<int>(std::lround(values[0])), values[1], values[2]});
  });
  preprocessor_.process(points_, objects_, points_.size() < raw_room_);
  nodes::host::Output& out = context.outputs[0];
  keep_nearest(objects_, out.layout().max_elements);
  out.begin(measurement.sequence, static_cast<int>(objects_.size()), measurement.at);
  for (int i = 0; i < static_cast<int>(objects_.size()); ++i) {
    const LaserObject& object = objects_[static_cast<std::size_t>(i)];
    using ttf::fusion::sensors::SeenPoint;
    const bool corner = object.seen == SeenPoint::kCorner;
    const int valid = object.seen == SeenPoint::kRightmost ? kRightmost
                      : object.seen == SeenPoint::kLeftmost
                          ? kLeftmost
                          : (object.has_heading ? kValidHeading : 0) + (object.has_length ? kValidLength : 0) +
                                (object.has_width ? kValidWidth : 0) + (corner ? kValidCorner : 0);
    const double values[] = {object.x,
                             object.y,
                             object.heading,
                             object.length,
                             object.width,
                             object.sigma_x(),
                             object.sigma_y(),
                             object.correlation(),
                             object.sigma_heading,
                             object.sigma_length,
                             object.sigma_width,
                             static_cast<double>(valid)};
    for (std::size_t s = 0; s < signals_.size(); ++s)
      if (s == 9 || s == 10)  // the sizes' uncertainties, of the order of the resolution
        out.set_at_least(i, signals_[s], values[s]);
      else
        out.set(i, signals_[s], values[s]);
  }
}

}  // namespace ttf::sensors::laser
