#include "fusion/tracks/parts/classes.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "fusion/tracks/body/size_evidence.h"

namespace ttf::fusion::tracks::parts {
namespace {

// As log_density_of_span(), for an aspect of which nothing is known: the mean density over all aspects.
double log_density_of_any_aspect(const body::Extent& extent, const SeenSpan& span) {
  constexpr int kAspects = 9;        // between the end and the side
  constexpr double kLeast = 1e-300;  // has a finite logarithm
  double density = 0.0;
  for (int k = 0; k < kAspects; ++k) {
    const double angle = (k + 0.5) / kAspects * 0.5 * std::numbers::pi;
    const auto at =
        log_density_of_span(extent, {span.aspect.range, span.aspect.sigma_range, angle, 0.0}, span.angle, span.sigma);
    if (at) density += std::exp(*at) / kAspects;
  }
  return std::log(std::max(kLeast, density));
}

double log_density(const body::Extent& extent, const SeenSpan& span) {
  const auto known = log_density_of_span(extent, span.aspect, span.angle, span.sigma);
  return known ? *known : log_density_of_any_aspect(extent, span);
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
  const std::optional<linear::Gaussian<2>> velocity =
      config.odometry ? std::optional(estimators::velocity_of(estimator.cartesian(track.estimate))) : std::nullopt;
  std::size_t best = track.class_index;
  double most = 0.0;
  body::Extent extent = track.extent;
  for (std::size_t k = 0; k < config.classes.size(); ++k) {
    const config::ClassPrior& of = config.classes[k];
    const body::Explained by = body::explained(evidence, of.sizes);
    double weight = std::log(of.share) + by.log_likelihood +
                    log_of_reports(track.unfiltered.classes, of.id, config.class_confusion);
    if (span) weight += log_density(by.extent, *span);
    if (velocity) weight += log_of_speed(*velocity, of.speed_sigma);
    if (k > 0 && weight <= most) continue;
    most = weight;
    best = k;
    extent = by.extent;
  }
  if (best == track.class_index) return;
  track.class_index = static_cast<std::uint8_t>(best);
  track.extent = extent;
}

}  // namespace ttf::fusion::tracks::parts
