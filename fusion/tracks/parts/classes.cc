#include "fusion/tracks/parts/classes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "fusion/tracks/body/centre.h"
#include "fusion/tracks/body/reading.h"
#include "fusion/tracks/body/size_evidence.h"

namespace ttf::fusion::tracks::parts {
namespace {

constexpr double kLeast = 1e-300;  // a density whose logarithm is finite

// As log_density_of_span(), for an unknown aspect, or an outline that would surround the sensor: the mean density over all aspects,
// where those that surround the sensor count as 0.
double log_density_of_any_aspect(const body::Extent& extent, const body::Aspect& aspect, const SeenSpan& span) {
  constexpr int kAspects = 9;  // between the end and the side
  double density = 0.0;
  for (int k = 0; k < kAspects; ++k) {
    const double angle = (k + 0.5) / kAspects * 0.5 * std::numbers::pi;
    const auto at = log_density_of_span(extent, {aspect.range, aspect.sigma_range, angle, 0.0}, span.angle, span.sigma);
    if (at) density += std::exp(*at) / kAspects;
  }
  return std::log(std::max(kLeast, density));
}

// The body has this extent, which decides where its centre is, and so the range.
double log_density(body::Body body, const body::Extent& extent, const estimators::Cartesian& estimate,
                   const SeenSpan& span) {
  body.extent = extent;
  const std::optional<body::Aspect> aspect = aspect_of(body, estimate, span.from);
  if (!aspect) return std::log(kLeast);
  const auto known = log_density_of_span(extent, *aspect, span.angle, span.sigma);
  return known ? *known : log_density_of_any_aspect(extent, *aspect, span);
}

double log_of_reports(const Classification& reported, sensors::ClassId id, double confusion) {
  constexpr double kOthers = config::kClassCount - 1;
  double all = 0.0;
  for (const double sum : reported.sums) all += sum;
  const double own = id == sensors::kNoClass ? 0.0 : reported.sums[static_cast<std::size_t>(id)];
  return own * std::log1p(-confusion) + (all - own) * std::log(confusion / kOthers);
}

double log_of_speed(const linear::Gaussian<2>& velocity, double sigma) {
  const double variance = sigma * sigma + 0.5 * velocity.p.trace();
  return -0.5 * velocity.x.squaredNorm() / variance - std::log(variance);
}

// The velocity is the centre's, and the axis that of the length.
double log_density_of_course(const linear::Gaussian<2>& velocity, const body::Heading& axis) {
  constexpr double kAny = 0.01, kAnySigma = 20.0;  // the probability of any velocity, and its standard deviation [m/s]
  const linear::Vector<2> across(-std::sin(axis.value), std::cos(axis.value));
  const double sideways = across.dot(velocity.x), stated = across.dot(velocity.p * across);
  const double variance = stated + body::kSlip * body::kSlip +
                          (body::kSlipOfSpeed * body::kSlipOfSpeed + axis.variance) * velocity.x.squaredNorm();
  const auto density = [&](double of) { return std::exp(-0.5 * sideways * sideways / of) / std::sqrt(of); };
  return std::log((1.0 - kAny) * density(variance) + kAny * density(stated + kAnySigma * kAnySigma));
}

body::SizeEvidence read_otherwise(const body::SizeEvidence& evidence) {
  body::SizeEvidence other;
  other.information = evidence.information.reverse();
  other.weighted = evidence.weighted.reverse();
  return other;
}

// The weights of all configured classes for one reading: their sum, and the most probable class.
struct Weighed {
  double log_sum = -std::numeric_limits<double>::infinity();
  double most = -std::numeric_limits<double>::infinity();
  std::size_t best = 0;
  body::Extent extent{config::Sizes{}};
};

Weighed weigh(const Track& track, const body::Body& body, const body::SizeEvidence& evidence,
              const estimators::Cartesian& estimate, const config::TrackerConfig& config, const SeenSpan* span) {
  const linear::Gaussian<2> velocity = estimators::velocity_of(estimate);
  Weighed all;
  all.best = track.class_index;
  all.extent = track.extent;
  std::array<double, config::kClassCount> weights{};
  for (std::size_t k = 0; k < config.classes.size(); ++k) {
    const config::ClassPrior& of = config.classes[k];
    const body::Explained by = body::explained(evidence, of.sizes);
    double& weight = weights[k];
    weight = std::log(of.share) + by.log_likelihood +
             log_of_reports(track.unfiltered.classes, of.id, config.class_confusion);
    if (span) weight += log_density(body, by.extent, estimate, *span);
    if (config.odometry) weight += log_of_speed(velocity, of.speed_sigma);
    if (!(weight > all.most)) continue;
    all.most = weight;
    all.best = k;
    all.extent = by.extent;
  }
  double sum = 0.0;
  for (std::size_t k = 0; k < config.classes.size(); ++k) sum += std::exp(weights[k] - all.most);
  all.log_sum = all.most + std::log(sum);
  return all;
}

body::Body read_otherwise(body::Body body) {
  body.heading = body::read_otherwise(body.heading);
  body.anchor = body::read_otherwise(body.anchor);
  return body;
}

// Both readings of a track. Without a known heading there is one.
struct Readings {
  Weighed present, other;
  double log_odds = -std::numeric_limits<double>::infinity();  // for the other reading
};

Readings readings_of(const Track& track, const config::TrackerConfig& config, const estimators::Estimator& estimator,
                     const SeenSpan* span) {
  const body::SizeEvidence evidence = body::evidence_of(track.extent, prior_of(track, config));
  const estimators::Cartesian estimate = estimator.cartesian(track.estimate);
  Readings readings;
  readings.present = weigh(track, track, evidence, estimate, config, span);
  if (!track.heading.known) return readings;
  const body::Body other = read_otherwise(static_cast<const body::Body&>(track));
  readings.other = weigh(track, other, read_otherwise(evidence), estimate, config, span);
  const linear::Gaussian<2> velocity = estimators::velocity_of(centred(track, estimate).estimate);
  readings.log_odds = readings.other.log_sum + log_density_of_course(velocity, other.heading) -
                      readings.present.log_sum - log_density_of_course(velocity, track.heading);
  return readings;
}

}  // namespace

double log_odds_of_other_reading(const Track& track, const config::TrackerConfig& config,
                                 const estimators::Estimator& estimator, const SeenSpan* span) {
  return readings_of(track, config, estimator, span).log_odds;
}

void choose_class(Track& track, const config::TrackerConfig& config, const estimators::Estimator& estimator,
                  const SeenSpan* span) {
  if (!chooses_class(config)) return;
  const Readings readings = readings_of(track, config, estimator, span);
  const bool anew = readings.log_odds > 0.0;
  const Weighed& best = anew ? readings.other : readings.present;
  if (!anew && best.best == track.class_index) return;
  if (anew) {
    track.heading = body::read_otherwise(track.heading);
    track.anchor = body::read_otherwise(track.anchor);
    update_front(track.heading, estimators::velocity_of(estimator.cartesian(track.estimate)));
  }
  track.class_index = static_cast<std::uint8_t>(best.best);
  track.extent = best.extent;
}

}  // namespace ttf::fusion::tracks::parts
