#include "fusion/tracks/parts/twins.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "fusion/metrics/chi_square.h"
#include "fusion/tracks/body/centre.h"
#include "fusion/tracks/parts/classes.h"

namespace ttf::fusion::tracks::parts {
namespace {

struct Difference {
  double squared = 0.0;
  int degrees = 4;
};

Difference difference_of(const estimators::Cartesian& a, const body::Extent& a_size, const estimators::Cartesian& b,
                         const body::Extent& b_size) {
  const linear::Vector<4> d = (a.x - b.x).head<4>();
  const linear::Matrix<4> sum = (a.p + b.p).topLeftCorner<4, 4>();
  Difference difference{.squared = d.dot(sum.ldlt().solve(d))};
  const bool known[] = {a_size.length_is_measured() && b_size.length_is_measured(),
                        a_size.width_is_measured() && b_size.width_is_measured()};
  for (Eigen::Index side = 0; side < 2; ++side) {
    if (!known[side]) continue;
    const double apart = a_size.size(side) - b_size.size(side);
    difference.squared += apart * apart / (a_size.covariance(side, side) + b_size.covariance(side, side));
    ++difference.degrees;
  }
  return difference;
}

estimators::Cartesian centre_of(const Track& track, const estimators::Estimator& estimator) {
  return centred(track, estimator.cartesian(track.estimate)).estimate;
}

// Returns the uncertainty of a track's motion as one number.
double volume_of(const Track& track, const estimators::Estimator& estimator) {
  return estimator.cartesian(track.estimate).p.topLeftCorner<4, 4>().eval().determinant();
}

// Returns whether the axes of both tracks are a quarter turn apart (fusion/tracks/body/reading.h).
bool read_differently(const body::Heading& a, const body::Heading& b) {
  return a.known && b.known && std::abs(std::sin(a.value - b.value)) > std::numbers::sqrt2 / 2.0;
}

// Joins the axes and the sizes of two tracks that read their object alike. The anchor has been chosen, in the axes of `sense`.
void join_bodies(Track& elder, const Track& younger, const body::Heading& sense) {
  const body::Heading elder_heading = elder.heading;
  if (younger.heading.known && (!elder.heading.known || younger.heading.variance < elder.heading.variance))
    elder.heading = younger.heading;
  take_front(elder.heading, elder_heading);
  take_front(elder.heading, younger.heading);
  if (sense.known && body::nearest_half_turn(elder.heading.value, sense.value) != elder.heading.value)
    elder.anchor = opposite(elder.anchor);
  // Each counts over that of its prior, as classes begin with different ones.
  if (younger.extent.covariance.determinant() * elder.extent.prior_variances.prod() <
      elder.extent.covariance.determinant() * younger.extent.prior_variances.prod()) {
    elder.extent = younger.extent;
    elder.class_index = younger.class_index;  // whose prior the extent has
  }
}

void join(Track& elder, const Track& younger, const estimators::Estimator& estimator, bool reads_both) {
  const bool alike = !reads_both || !read_differently(elder.heading, younger.heading);
  body::Heading sense = elder.heading;  // the axes of the anchor
  if (volume_of(younger, estimator) < volume_of(elder, estimator)) {
    elder.estimate = younger.estimate;
    elder.anchor = younger.anchor;
    elder.lists_elsewhere = younger.lists_elsewhere;
    sense = younger.heading;
    if (!alike) {  // the reading goes with the anchor
      elder.heading = younger.heading;
      elder.extent = younger.extent;
      elder.class_index = younger.class_index;
    }
  }
  if (alike) join_bodies(elder, younger, sense);
  if (younger.shown.known && (!elder.shown.known || younger.shown.variance < elder.shown.variance))
    elder.shown = younger.shown;
  auto& sums = elder.unfiltered.classes.sums;
  for (std::size_t i = 0; i < sums.size(); ++i) sums[i] += younger.unfiltered.classes.sums[i];
  const bool newer = younger.newest.measured > elder.newest.measured;
  if (newer) elder.newest = younger.newest;
  elder.shared = std::max(elder.shared, younger.shared);
  sensors::ThirdAxis& third = elder.unfiltered.third;
  const sensors::ThirdAxis& other = younger.unfiltered.third;
  if (other.has_z && (newer || !third.has_z)) {
    third.has_z = true;
    third.z = other.z;
  }
  if (other.has_height && (newer || !third.has_height)) {
    third.has_height = true;
    third.height = other.height;
  }
  elder.doubtful &= ~(younger.hits & ~younger.doubtful);
  elder.hits |= younger.hits;
  elder.misses = std::min(elder.misses, younger.misses);
  elder.existence = std::max(elder.existence, younger.existence);
}

}  // namespace

Twins::Twins(const config::TrackerConfig& config, std::size_t max_tracks)
    : lists_(config.merge_scans), reads_both_(chooses_class(config)) {
  if (config.merge_probability <= 0.0) return;
  for (int degrees = 4; degrees <= 6; ++degrees)
    quantile_[degrees] = metrics::chi_square_quantile(config.merge_probability, degrees);
  by_x_.reserve(max_tracks);
  nearest_.reserve(max_tracks);
}

void Twins::find_nearest(const std::vector<Track>& tracks, const estimators::Estimator& estimator) {
  by_x_.clear();
  nearest_.assign(tracks.size(), {});
  double largest = 0.0;
  for (std::size_t t = 0; t < tracks.size(); ++t) {
    if (!tracks[t].confirmed) continue;
    by_x_.push_back({centre_position(tracks[t], estimator.cartesian(tracks[t].estimate)).estimate, t});
    largest = std::max(largest, by_x_.back().at.p(0, 0));
  }
  std::sort(by_x_.begin(), by_x_.end(), [](const Seen& a, const Seen& b) {
    return a.at.x(0) != b.at.x(0) ? a.at.x(0) < b.at.x(0) : a.track < b.track;
  });
  // Beyond this distance on one axis, the quantile of the most degrees excludes a pair.
  const auto reach = [&](double variance) { return std::sqrt(quantile_[6] * variance) * (1.0 + 1e-12); };
  for (std::size_t i = 0; i < by_x_.size(); ++i) {
    const linear::Gaussian<2>& at = by_x_[i].at;
    const double reach_x = reach(at.p(0, 0) + largest);
    for (std::size_t j = i + 1; j < by_x_.size() && by_x_[j].at.x(0) - at.x(0) <= reach_x; ++j) {
      if (std::abs(by_x_[j].at.x(1) - at.x(1)) > reach(at.p(1, 1) + by_x_[j].at.p(1, 1))) continue;
      const std::size_t elder = std::min(by_x_[i].track, by_x_[j].track);
      const std::size_t younger = std::max(by_x_[i].track, by_x_[j].track);
      const Track &one = tracks[by_x_[i].track], &other = tracks[by_x_[j].track];
      const Difference apart =
          difference_of(centre_of(one, estimator), one.extent, centre_of(other, estimator), other.extent);
      const double distance = apart.squared / quantile_[apart.degrees];
      if (!(distance <= 1.0)) continue;
      Nearest& nearest = nearest_[younger];
      const int candidate = static_cast<int>(elder);
      if (nearest.elder < 0 || distance < nearest.distance ||
          (distance == nearest.distance && candidate < nearest.elder))
        nearest = {candidate, distance};
    }
  }
}

void Twins::unite(std::vector<Track>& tracks, const sensors::ObservationList& list,
                  const estimators::Estimator& estimator) {
  find_nearest(tracks, estimator);
  const auto seen = [&](const Track& track) {
    return track.newest.measurement == list.id && track.newest.measured == list.measured;
  };
  for (std::size_t t = tracks.size(); t-- > 0;) {
    Track& younger = tracks[t];
    if (nearest_[t].elder < 0) {
      younger.twin_lists = 0;
      continue;
    }
    Track& elder = tracks[static_cast<std::size_t>(nearest_[t].elder)];
    if (younger.twin_lists == 0 || !(younger.twin == elder.birth)) {
      younger.twin = elder.birth;
      younger.twin_lists = 0;
    }
    const bool elder_seen = seen(elder), younger_seen = seen(younger);
    if (elder_seen && younger_seen)
      younger.twin_lists = 0;
    else if (elder_seen || younger_seen)
      ++younger.twin_lists;
    if (younger.twin_lists < lists_) continue;
    join(elder, younger, estimator, reads_both_);
    tracks.erase(tracks.begin() + static_cast<std::ptrdiff_t>(t));
  }
}

}  // namespace ttf::fusion::tracks::parts
