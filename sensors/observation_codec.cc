#include "sensors/observation_codec.h"

#include <algorithm>

#include "fusion/config/classes.h"
#include "nodes/host/signals.h"
#include "nodes/host/step.h"
#include "sensors/silhouette_signals.h"

namespace ttf::sensors {
namespace {

// At least half the code's step. Fixed-point coding adds far less uncertainty than any sensor, but a sigma of
// zero would mean certainty.
double at_least_resolution(double sigma, double resolution) { return std::max(sigma, 0.5 * resolution); }

ttf::fusion::sensors::SeenPoint seen_point(int valid) {
  using ttf::fusion::sensors::SeenPoint;
  if (valid == kValidCorner) return SeenPoint::kCentre;
  if (valid == kRightmost) return SeenPoint::kRightmost;
  if (valid == kLeftmost) return SeenPoint::kLeftmost;
  if (!(valid & kValidHeading)) return SeenPoint::kSilhouette;
  if (valid & kValidCorner) return SeenPoint::kCorner;
  switch (valid & (kValidLength | kValidWidth)) {
    case kValidWidth: return SeenPoint::kEnd;
    case kValidLength: return SeenPoint::kSide;
    case 0: return SeenPoint::kSilhouette;
    default: return SeenPoint::kCentre;
  }
}

// A code that is no class is none.
void take_class(ttf::fusion::sensors::Observation& observation, double code) {
  if (!(code >= 0.0 && code < ttf::fusion::config::kClassCount)) return;
  observation.class_id = static_cast<ttf::fusion::sensors::ClassId>(code);
  observation.score = 1.0;
}

}  // namespace

ObservationCodec::ObservationCodec(const schedules::model::Cluster& cluster, PduId pdu)
    : layout_(&cluster.pdu(pdu)),
      form_(schedules::model::find_signal(layout_->element, "range")     ? Form::kRadar
            : schedules::model::find_signal(layout_->element, "heading") ? Form::kLaser
                                                                         : Form::kPosition) {
  switch (form_) {
    case Form::kLaser:
      signals_ = nodes::host::bind_elements<12>(cluster, *layout_,
                                                {"x", "y", "sigma_x", "sigma_y", "correlation", "width", "sigma_width",
                                                 "heading", "sigma_heading", "length", "sigma_length", "valid"});
      break;
    case Form::kPosition: signals_ = bind_silhouettes(cluster, *layout_); break;
    case Form::kRadar:
      returns_ = schedules::model::find_signal(layout_->element, "returns");
      signals_ = returns_ ? nodes::host::bind_elements<7>(cluster, *layout_,
                                                          {"range", "bearing", "range_rate", "sigma_range",
                                                           "sigma_bearing", "sigma_range_rate", "returns"})
                          : nodes::host::bind_elements<6>(
                                cluster, *layout_,
                                {"range", "bearing", "range_rate", "sigma_range", "sigma_bearing", "sigma_range_rate"});
      break;
  }
}

void ObservationCodec::decode(const bus::cni::ListView& list,
                              std::vector<ttf::fusion::sensors::Observation>& out) const {
  out.clear();
  const int count = nodes::host::element_count(*layout_, list);
  for (int i = 0; i < count; ++i) {
    const auto value = [&](std::size_t s) { return nodes::host::element_value(*layout_, list, i, signals_[s]); };
    const auto sigma = [&](std::size_t s) {
      return at_least_resolution(value(s), layout_->element[signals_[s]].resolution);
    };
    ttf::fusion::sensors::Observation observation{};
    observation.z.setZero();
    observation.r.setZero();
    if (form_ == Form::kRadar) {
      observation.kind = ttf::fusion::sensors::ObservationKind::kRangeBearingRate;
      for (std::size_t k = 0; k < 3; ++k) {
        const auto row = static_cast<Eigen::Index>(k);
        observation.z(row) = value(k);
        observation.r(row, row) = sigma(3 + k) * sigma(3 + k);
      }
      if (returns_)
        observation.returns = static_cast<std::uint8_t>(nodes::host::element_value(*layout_, list, i, *returns_));
      if (observation.returns > 0) observation.seen = ttf::fusion::sensors::SeenPoint::kSilhouette;
    } else {
      observation.kind = ttf::fusion::sensors::ObservationKind::kPosition;
      const double sigma_x = sigma(2), sigma_y = sigma(3);
      // The coded correlation stays below one, so the covariance stays positive definite.
      const double covariance = std::clamp(value(4), -0.99, 0.99) * sigma_x * sigma_y;
      observation.z(0) = value(0);
      observation.z(1) = value(1);
      observation.r(0, 0) = sigma_x * sigma_x;
      observation.r(0, 1) = observation.r(1, 0) = covariance;
      observation.r(1, 1) = sigma_y * sigma_y;
      if (form_ == Form::kPosition) {
        observation.seen = ttf::fusion::sensors::SeenPoint::kSilhouette;
        observation.has_span = true;
        observation.span = value(5);
        observation.sigma_span = sigma(6);
        if (signals_.size() > kClassSignal) take_class(observation, value(kClassSignal));
      } else {
        observation.width = value(5);
        observation.sigma_width = sigma(6);
        const int valid = static_cast<int>(value(11));
        observation.seen = seen_point(valid);
        observation.has_heading = valid & kValidHeading;
        observation.has_length = (valid & kValidLength) && !is_outermost(observation.seen);
        observation.has_width = (valid & kValidWidth) && !is_outermost(observation.seen);
        observation.heading = value(7);
        observation.sigma_heading = sigma(8);
        observation.length = value(9);
        observation.sigma_length = sigma(10);
      }
    }
    out.push_back(observation);
  }
}

}  // namespace ttf::sensors
