#include "tests/fusion/scenes.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <type_traits>

namespace ttf::fusion {

sensors::Observation position(double x, double y, double sigma) {
  sensors::Observation z;
  z.z << x, y, 0.0;
  z.r.topLeftCorner<2, 2>() = sigma * sigma * Eigen::Matrix2d::Identity();
  return z;
}

sensors::Observation radar(double range, double bearing, double rate, double sigma_range, double sigma_bearing,
                           double sigma_rate) {
  sensors::Observation z;
  z.kind = sensors::ObservationKind::kRangeBearingRate;
  z.z << range, bearing, rate;
  z.r = Eigen::Vector3d(sigma_range * sigma_range, sigma_bearing * sigma_bearing, sigma_rate * sigma_rate).asDiagonal();
  return z;
}

int confirmed(const tracks::TrackSet& set) {
  return static_cast<int>(
      std::count_if(set.tracks.begin(), set.tracks.end(), [](const tracks::Track& t) { return t.confirmed; }));
}

config::TrackerConfig config_of(config::MotionModel motion, double process_noise, config::FilterKind filter) {
  config::TrackerConfig config;
  config.motion = motion;
  config.process_noise = process_noise;
  config.filter = filter;
  return config;
}

estimators::Estimate estimate_of(config::MotionModel motion, const estimators::State& x,
                                 const estimators::Covariance& p) {
  if (motion == config::MotionModel::kConstantAcceleration) return linear::Gaussian<6>{x, p};
  return linear::Gaussian<4>{x.head<4>(), p.topLeftCorner<4, 4>()};
}

estimators::Cartesian seen_as(const estimators::Estimate& estimate) {
  if (const auto* whole = std::get_if<linear::Gaussian<6>>(&estimate)) return *whole;
  if (const auto* whole = std::get_if<estimators::WithBiases<6>>(&estimate)) return whole->state;
  const auto* with_biases = std::get_if<estimators::WithBiases<4>>(&estimate);
  const auto& known = with_biases != nullptr ? with_biases->state : std::get<linear::Gaussian<4>>(estimate);
  estimators::Cartesian seen;
  seen.x.head<4>() = known.x;
  seen.p.topLeftCorner<4, 4>() = known.p;
  return seen;
}

tracks::TrackView shown(const tracks::Track& track, GlobalTime time, GlobalTime at,
                        const config::TrackerConfig& config) {
  return view_of(track, time, at, config, *estimators::make_estimator(config));
}

estimators::Covariance transition(config::MotionModel motion, double dt) {
  estimators::Covariance f = estimators::Covariance::Identity();
  for (int axis = 0; axis < 2; ++axis) {
    f(axis, axis + 2) = dt;
    if (motion == config::MotionModel::kConstantAcceleration) {
      f(axis, axis + 4) = dt * dt / 2.0;
      f(axis + 2, axis + 4) = dt;
    }
  }
  return f;
}

estimators::Covariance driving_noise(config::MotionModel motion, double q, double dt) {
  // Three nodes: exact to degree 5, and the highest power here is 4.
  const double nodes[] = {-std::sqrt(0.6), 0.0, std::sqrt(0.6)}, weights[] = {5.0 / 9.0, 8.0 / 9.0, 5.0 / 9.0};
  const int driven = motion == config::MotionModel::kConstantAcceleration ? 4 : 2;
  estimators::Covariance sum = estimators::Covariance::Zero();
  for (int i = 0; i < 3; ++i) {
    const Eigen::Matrix<double, 6, 2> g = transition(motion, 0.5 * dt * (1.0 + nodes[i])).middleCols<2>(driven);
    sum += 0.5 * dt * weights[i] * q * g * g.transpose();
  }
  return sum;
}

estimators::State draw(const estimators::State& mean, const estimators::Covariance& covariance, RandomStream& stream) {
  estimators::State unit;
  for (int i = 0; i < 6; ++i) unit(i) = stream.normal();
  const Eigen::LDLT<estimators::Covariance> ldlt(covariance);
  const estimators::State scaled = ldlt.vectorD().cwiseMax(0.0).cwiseSqrt().cwiseProduct(unit);
  const estimators::State coloured = ldlt.transpositionsP().transpose() * (ldlt.matrixL() * scaled).eval();
  return mean + coloured;
}

namespace {

template <int R, int C> bool same(const Eigen::Matrix<double, R, C>& a, const Eigen::Matrix<double, R, C>& b) {
  return std::memcmp(a.data(), b.data(), sizeof(double) * static_cast<std::size_t>(a.size())) == 0;
}
bool same(double a, double b) { return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b); }
bool same(const tracks::body::Scalar& a, const tracks::body::Scalar& b) {
  return same(a.value, b.value) && same(a.variance, b.variance) && a.known == b.known;
}

template <int N> bool same(const linear::Gaussian<N>& a, const linear::Gaussian<N>& b) {
  return same(a.x, b.x) && same(a.p, b.p);
}
bool same(const estimators::StraightOrTurning& a, const estimators::StraightOrTurning& b) {
  return same(std::get<0>(a.estimates), std::get<0>(b.estimates)) &&
         same(std::get<1>(a.estimates), std::get<1>(b.estimates)) && same(a.probability, b.probability);
}
template <int N> bool same(const estimators::WithBiases<N>& a, const estimators::WithBiases<N>& b) {
  return same(a.state, b.state) && same(a.cross, b.cross);
}

}  // namespace

bool same_bits(const estimators::Estimate& a, const estimators::Estimate& b) {
  return a.index() == b.index() &&
         std::visit([&](const auto& own) { return same(own, std::get<std::remove_cvref_t<decltype(own)>>(b)); }, a);
}

bool same_bits(const tracks::TrackSet& a, const tracks::TrackSet& b) {
  return a.time == b.time && a.started == b.started &&
         std::equal(a.tracks.begin(), a.tracks.end(), b.tracks.begin(), b.tracks.end(),
                    [](const tracks::Track& s, const tracks::Track& t) {
                      return s.birth == t.birth && s.newest == t.newest && same_bits(s.estimate, t.estimate) &&
                             same(s.heading, t.heading) && same(s.heading.rate, t.heading.rate) &&
                             same(s.extent.size, t.extent.size) && same(s.extent.covariance, t.extent.covariance) &&
                             s.hits == t.hits && s.lists == t.lists && s.misses == t.misses &&
                             s.confirmed == t.confirmed && same(s.existence, t.existence) &&
                             s.twin_lists == t.twin_lists && (s.twin_lists == 0 || s.twin == t.twin);
                    });
}

bool same_bits(const std::vector<tracks::TrackView>& a, const std::vector<tracks::TrackView>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const tracks::TrackView& s, const tracks::TrackView& t) {
    return s.id == t.id && s.valid_at == t.valid_at && same(s.state, t.state) && same(s.covariance, t.covariance) &&
           same(s.heading, t.heading) && same(s.sigma_heading, t.sigma_heading) && same(s.speed, t.speed) &&
           same(s.sigma_speed, t.sigma_speed) && same(s.acceleration, t.acceleration) &&
           same(s.sigma_acceleration, t.sigma_acceleration) && same(s.length, t.length) &&
           same(s.sigma_length, t.sigma_length) && same(s.width, t.width) && same(s.sigma_width, t.sigma_width) &&
           s.confirmed == t.confirmed && s.coasting == t.coasting && s.has_length == t.has_length &&
           s.has_width == t.has_width;
  });
}

estimators::State Lanes::truth(int object, GlobalTime at) const {
  const double t = (at - GlobalTime{}).seconds();
  estimators::State x = estimators::State::Zero();
  const int row = object / across, lane = object % across - across / 2;
  x(2) = 3.0 + 0.5 * row;
  x(3) = 0.1 * lane;
  x(0) = 10.0 + 12.0 * row + x(2) * t;
  x(1) = 6.0 * lane + x(3) * t;
  return x;
}

std::vector<sensors::Observation> Lanes::see(GlobalTime at, std::uint32_t index) const {
  RandomStream stream({.seed = seed, .purpose = Purpose::kTest, .entity = 77, .index = index});
  std::vector<sensors::Observation> seen;
  for (int object = 0; object < objects; ++object) {
    const estimators::State x = truth(object, at);
    sensors::Observation z = position(x(0) + sigma * stream.normal(), x(1) + sigma * stream.normal(), sigma);
    z.has_heading = z.has_length = z.has_width = true;
    z.heading = std::atan2(x(3), x(2)) + 0.05 * stream.normal();
    z.length = 4.5 + 0.1 * stream.normal();
    z.width = 1.8 + 0.1 * stream.normal();
    z.sigma_heading = 0.05;
    z.sigma_length = z.sigma_width = 0.1;
    if (stream.uniform() >= miss_probability) seen.push_back(z);
  }
  for (std::size_t i = seen.size(); i > 1; --i)
    std::swap(seen[i - 1], seen[static_cast<std::size_t>(stream.integer(0, static_cast<std::int64_t>(i) - 1))]);
  return seen;
}

}  // namespace ttf::fusion
