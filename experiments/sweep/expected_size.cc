#include "experiments/sweep/expected_size.h"

#include <algorithm>
#include <cmath>

#include "experiments/cost/dense.h"

namespace ttf::experiments::sweep {
namespace {

// The part of a standard normal number between `low` and `high` for which mean + sigma times it is in the limits.
struct Part {
  double low, high;
};
Part within(const Part& whole, double mean, double sigma, double least, double most) {
  if (sigma <= 0.0) return mean < least || mean > most ? Part{0.0, 0.0} : whole;
  return {std::max(whole.low, (least - mean) / sigma), std::min(whole.high, (most - mean) / sigma)};
}

// Sums over both standard normal numbers that size.cc draws. So a correlation of 1 is no special case.
SizeMoments of_normal(const sim::world::SizeConfig& config) {
  constexpr int kSteps = 200;
  constexpr Part kAll{-6.0, 6.0};
  const double rest = std::sqrt(1.0 - config.correlation * config.correlation);
  const sim::world::SizeLimits& limits = config.normal;
  const Part lengths = within(kAll, config.mean.length, config.sigma.length, limits.shortest, limits.longest);
  double sum = 0.0;
  Eigen::Vector2d first = Eigen::Vector2d::Zero();
  Eigen::Matrix2d second = Eigen::Matrix2d::Zero();
  for (int i = 0; i < kSteps; ++i) {
    const double a = lengths.low + (i + 0.5) / kSteps * (lengths.high - lengths.low);
    const double by_length = config.sigma.width * config.correlation * a;
    const Part widths =
        within(kAll, config.mean.width + by_length, config.sigma.width * rest, limits.narrowest, limits.widest);
    for (int j = 0; j < kSteps && widths.low < widths.high; ++j) {
      const double step = (widths.high - widths.low) / kSteps, b = widths.low + (j + 0.5) * step;
      const Eigen::Vector2d off(config.sigma.length * a, by_length + config.sigma.width * rest * b);
      const double weight = step * std::exp(-0.5 * (a * a + b * b));
      sum += weight;
      first += weight * off;
      second += weight * off * off.transpose();
    }
  }
  first /= sum;
  return {Eigen::Vector2d(config.mean.length, config.mean.width) + first, second / sum - first * first.transpose()};
}

SizeMoments of_uniform(const sim::world::SizeLimits& limits) {
  const Eigen::Vector2d low(limits.shortest, limits.narrowest), high(limits.longest, limits.widest);
  SizeMoments moments{0.5 * (low + high), {}};
  moments.covariance = (high - low).cwiseAbs2().asDiagonal() * (1.0 / 12.0);
  return moments;
}

}  // namespace

SizeMoments moments_of(const sim::world::SizeConfig& config, const sim::world::Size& nominal) {
  switch (config.draw) {
    case sim::world::SizeDraw::kNormal: return of_normal(config);
    case sim::world::SizeDraw::kUniform: return of_uniform(config.uniform);
    case sim::world::SizeDraw::kNominal: break;
  }
  return {{nominal.length, nominal.width}, Eigen::Matrix2d::Zero()};
}

SizeMoments moments_of(const fusion::config::Sizes& prior) {
  const double cross = prior.correlation * prior.length_sigma * prior.width_sigma;
  SizeMoments moments{{prior.length, prior.width}, {}};
  moments.covariance << prior.length_sigma * prior.length_sigma, cross, cross, prior.width_sigma * prior.width_sigma;
  return moments;
}

SizeRecursion::SizeRecursion(const SizeMoments& actual, const SizeMoments& prior) : believed_(prior.covariance) {
  const Eigen::Vector2d off = prior.mean - actual.mean;
  moments_ = actual.covariance + off * off.transpose();
}

void SizeRecursion::see(const SizeLook& look) {
  const double c = look.repeating;
  const Eigen::Vector2d ah = believed_ * look.h;
  const double p = look.h.dot(ah);
  if (p <= c) return;
  const double r = std::max(look.white + c, p * c / (p - c));
  const Eigen::Vector2d gain = ah / (p + r);
  const Eigen::Matrix2d rest = Eigen::Matrix2d::Identity() - gain * look.h.transpose();
  believed_ = (rest * believed_ * rest.transpose() + r * gain * gain.transpose()).eval();

  const auto at = static_cast<Eigen::Index>(2 + look.sensor), known = moments_.rows();
  if (at >= known) {
    const Eigen::MatrixXd before = moments_;
    moments_ = Eigen::MatrixXd::Identity(at + 1, at + 1);
    moments_.topLeftCorner(known, known) = before;
  }
  Eigen::MatrixXd step = Eigen::MatrixXd::Identity(moments_.rows(), moments_.cols());
  step.topLeftCorner<2, 2>() = rest;
  step.block<2, 1>(0, at) = std::sqrt(c) * gain;
  moments_ = cost::propagated(step, moments_);
  moments_.topLeftCorner<2, 2>() += look.white * gain * gain.transpose();
}

}  // namespace ttf::experiments::sweep
