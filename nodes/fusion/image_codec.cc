#include "nodes/fusion/image_codec.h"

#include <cmath>

#include "nodes/host/signals.h"

namespace ttf::nodes::fusion {
namespace {

using recording::records::ImageStatus;

double status_of(const ttf::fusion::tracks::TrackView& view) {
  ImageStatus status{};
  if (view.confirmed) status |= ImageStatus::kConfirmed;
  if (view.coasting) status |= ImageStatus::kCoasting;
  if (view.has_length) status |= ImageStatus::kHasLength;
  if (view.has_width) status |= ImageStatus::kHasWidth;
  return static_cast<double>(status);
}

}  // namespace

ImageSignals bind_image(const schedules::model::Cluster& cluster, const schedules::model::PduLayout& layout) {
  return host::bind_element(cluster, layout, kImageSignals);
}

void encode_image_object(const ttf::fusion::tracks::TrackView& view, host::Output& out, int index,
                         const ImageSignals& signals) {
  const double sigma_x = std::sqrt(view.covariance(0, 0)), sigma_y = std::sqrt(view.covariance(1, 1));
  const std::array<double, kImageSignals.size()> values{static_cast<double>(index_of(view.id)),
                                                        view.state(0),
                                                        view.state(1),
                                                        view.heading,
                                                        view.speed,
                                                        view.acceleration,
                                                        view.length,
                                                        view.width,
                                                        sigma_x,
                                                        sigma_y,
                                                        view.covariance(0, 1) / (sigma_x * sigma_y),
                                                        view.sigma_heading,
                                                        view.sigma_speed,
                                                        view.sigma_acceleration,
                                                        view.sigma_length,
                                                        view.sigma_width,
                                                        status_of(view)};
  // Sizes' uncertainties are of the order of the resolution.
  static_assert(kImageSignals[14] == "sigma_length" && kImageSignals[15] == "sigma_width");
  for (std::size_t s = 0; s < values.size(); ++s)
    if (s == 14 || s == 15)
      out.set_at_least(index, signals[s], values[s]);
    else
      out.set(index, signals[s], values[s]);
}

recording::records::ImageObject decode_image_object(const schedules::model::PduLayout& layout,
                                                    const bus::cni::ListView& list, int index,
                                                    const ImageSignals& signals) {
  const auto value = [&](std::size_t s) { return host::element_value(layout, list, index, signals[s]); };
  recording::records::ImageObject object;
  object.track = static_cast<TrackId>(std::lround(value(0)));
  double* const fields[] = {&object.x,
                            &object.y,
                            &object.heading,
                            &object.speed,
                            &object.acceleration,
                            &object.length,
                            &object.width,
                            &object.sigma_x,
                            &object.sigma_y,
                            &object.correlation_xy,
                            &object.sigma_heading,
                            &object.sigma_speed,
                            &object.sigma_acceleration,
                            &object.sigma_length,
                            &object.sigma_width};
  static_assert(std::size(fields) + 2 == kImageSignals.size(), "id, the numbers, status");
  for (std::size_t f = 0; f < std::size(fields); ++f) *fields[f] = value(f + 1);
  object.status = static_cast<ImageStatus>(std::lround(value(kImageSignals.size() - 1)));
  return object;
}

}  // namespace ttf::nodes::fusion
