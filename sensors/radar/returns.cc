#include "sensors/radar/returns.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

#include "core/check.h"

namespace ttf::sensors::radar {
namespace {

constexpr double kLeastSpeed = 0.25;  // [m/s]

double square(double x) { return x * x; }

}  // namespace

RadarPreprocessingConfig load_radar_preprocessing(YamlMap& yaml) {
  RadarPreprocessingConfig c;
  c.range_sigma_m = yaml.number_or("range_sigma", c.range_sigma_m, {0.001, 5.0}, "m");
  c.azimuth_sigma_rad = yaml.number_or("azimuth_sigma", c.azimuth_sigma_rad, {1e-5, 0.2}, "rad");
  c.rate_sigma_mps = yaml.number_or("range_rate_sigma", c.rate_sigma_mps, {0.001, 5.0}, "m/s");
  c.rate_span_mps = yaml.number_or("range_rate_span", c.rate_span_mps, {1.0, 400.0}, "m/s");
  c.range_gate_m = yaml.number_or("range_gate", c.range_gate_m, {0.0, 50.0}, "m");
  c.across_gate_m = yaml.number_or("across_gate", c.across_gate_m, {0.0, 50.0}, "m");
  c.rate_gate_mps = yaml.number_or("range_rate_gate", c.rate_gate_mps, {0.0, 50.0}, "m/s");
  c.transverse_speed_mps = yaml.number_or("transverse_speed", c.transverse_speed_mps, {0.0, 100.0}, "m/s");
  return c;
}

fusion::sensors::Resolution resolution_of(const RadarPreprocessingConfig& config) {
  return {config.range_gate_m,  config.across_gate_m,        config.azimuth_sigma_rad,
          config.rate_gate_mps, config.transverse_speed_mps, config.rate_span_mps};
}

ReturnJoiner::ReturnJoiner(const RadarPreprocessingConfig& config, std::size_t most_returns)
    : config_(config), resolution_(resolution_of(config)), taken_(most_returns) {
  members_.reserve(most_returns);
}

bool ReturnJoiner::together(const Return& a, const Return& b, const Resolution& resolution) const {
  return resolution.joins(std::min(a.range, b.range), a.range - b.range, a.azimuth - b.azimuth,
                          a.range_rate - b.range_rate);
}

// Range rates are averaged about the first return's: a fold may lie between them.
RadarObject ReturnJoiner::object_of(const std::vector<Return>& returns) const {
  const double n = static_cast<double>(members_.size()), root = std::sqrt(n);
  const Return& first = returns[members_.front()];
  double range = 0.0, azimuth = 0.0, rate = 0.0;  // from the first one's
  for (const std::size_t m : members_) {
    range += (returns[m].range - first.range) / n;
    azimuth += (returns[m].azimuth - first.azimuth) / n;
    rate += std::remainder(returns[m].range_rate - first.range_rate, config_.rate_span_mps) / n;
  }
  return {first.range + range,
          first.azimuth + azimuth,
          std::remainder(first.range_rate + rate, config_.rate_span_mps),
          config_.range_sigma_m / root,
          config_.azimuth_sigma_rad / root,
          config_.rate_sigma_mps / root,
          static_cast<int>(members_.size())};
}

// Takes the chain of returns that begins with this one.
void ReturnJoiner::take_chain(const std::vector<Return>& returns, std::size_t first, const Resolution& resolution) {
  members_.assign(1, first);
  taken_[first] = 1;
  for (std::size_t next = 0; next < members_.size(); ++next)
    for (std::size_t other = first + 1; other < returns.size(); ++other) {
      if (taken_[other] || !together(returns[members_[next]], returns[other], resolution)) continue;
      taken_[other] = 1;
      members_.push_back(other);
    }
}

// The least squares of a and b, with b between its bounds. The error of an azimuth changes the range rate by the velocity across.
double ReturnJoiner::chi_squared(const std::vector<Return>& returns, double fold) const {
  const Return& first = returns[members_.front()];
  using Row = std::array<double, 3>;  // cos, sin, range rate
  const auto row_of = [&](std::size_t m) {
    const double t = returns[m].azimuth - first.azimuth;
    const double later = std::remainder(returns[m].range_rate - first.range_rate, config_.rate_span_mps);
    return Row{std::cos(t), std::sin(t), first.range_rate + fold + later};
  };
  double cc = 0.0, cs = 0.0, ss = 0.0, cr = 0.0, sr = 0.0;
  for (const std::size_t m : members_) {
    const auto [c, s, rate] = row_of(m);
    cc += c * c, cs += c * s, ss += s * s, cr += c * rate, sr += s * rate;
  }
  const double determinant = cc * ss - cs * cs, most = config_.transverse_speed_mps;
  const double b = determinant > 1e-12 ? std::clamp((cc * sr - cs * cr) / determinant, -most, most) : 0.0;
  const double a = (cr - b * cs) / cc;
  double sum = 0.0;
  for (const std::size_t m : members_) {
    const auto [c, s, rate] = row_of(m);
    sum += square(rate - a * c - b * s) /
           (square(config_.rate_sigma_mps) + square((b * c - a * s) * config_.azimuth_sigma_rad));
  }
  return sum;
}

// A chi-squared of d degrees of freedom exceeds d + 2 sqrt(d x) + 2 x in one of exp(x) cases at most, here in one of a million (Laurent,
// Massart: Annals of Statistics 28, 2000, lemma 1). The weights follow from the fit. So its sum is somewhat larger. The range rates may be
// folded once.
bool ReturnJoiner::is_one_body(const std::vector<Return>& returns) const {
  if (members_.size() < 3) return true;
  constexpr double kX = 14.0;
  const double freedom = static_cast<double>(members_.size() - 2);
  const double most = freedom + 2.0 * std::sqrt(freedom * kX) + 2.0 * kX;
  for (const double folds : {0.0, -1.0, 1.0})
    if (chi_squared(returns, folds * config_.rate_span_mps) <= most) return true;
  return false;
}

void ReturnJoiner::join(const std::vector<Return>& returns, std::vector<RadarObject>& objects) {
  TTF_CHECK(returns.size() <= taken_.size(), "{} returns, room for {}", returns.size(), taken_.size());
  objects.clear();
  std::fill(taken_.begin(), taken_.end(), 0);
  const double least_rate = 5.0 * config_.rate_sigma_mps;  // narrower gates divide returns by their noise
  for (std::size_t first = 0; first < returns.size(); ++first) {
    if (taken_[first]) continue;
    Resolution resolution = resolution_;
    take_chain(returns, first, resolution);
    while (resolution.transverse_speed_mps > kLeastSpeed && !is_one_body(returns)) {
      for (const std::size_t m : members_) taken_[m] = 0;
      resolution.transverse_speed_mps *= 0.5;
      resolution.rate_mps = std::max(0.5 * resolution.rate_mps, std::min(resolution.rate_mps, least_rate));
      take_chain(returns, first, resolution);
    }
    objects.push_back(object_of(returns));
  }
  std::sort(objects.begin(), objects.end(), [](const RadarObject& a, const RadarObject& b) {
    return std::tuple(a.range, a.bearing) < std::tuple(b.range, b.bearing);
  });
}

}  // namespace ttf::sensors::radar
