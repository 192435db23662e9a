#include "fusion/tracks/parts/classes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "fusion/tracks/body/centre.h"
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

}  // namespace

void choose_class(Track& track, const config::TrackerConfig& config, const estimators::Estimator& estimator,
                  const SeenSpan* span) {
  if (config.classes.size() < 2) return;
  const body::SizeEvidence evidence = body::evidence_of(track.extent, prior_of(track, config));
  const estimators::Cartesian estimate = estimator.cartesian(track.estimate);
  const linear::Gaussian<2> velocity = estimators::velocity_of(estimate);
  std::size_t best = track.class_index;
  double most = -std::numeric_limits<double>::infinity();
  body::Extent extent = track.extent;
  for (std::size_t k = 0; k < config.classes.size(); ++k) {
    const config::ClassPrior& of = config.classes[k];
    const body::Explained by = body::explained(evidence, of.sizes);
    double weight = std::log(of.share) + by.log_likelihood +
                    log_of_reports(track.unfiltered.classes, of.id, config.class_confusion);
    if (span) weight += log_density(track, by.extent, estimate, *span);
    if (config.odometry) weight += log_of_speed(velocity, of.speed_sigma);
    if (!(weight > most)) continue;
    most = weight;
    best = k;
    extent = by.extent;
  }
  if (best == track.class_index) return;
  track.class_index = static_cast<std::uint8_t>(best);
  track.extent = extent;
}

}  // namespace ttf::fusion::tracks::parts
