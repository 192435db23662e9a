#include "schedules/sequence/expected_error.h"

#include <algorithm>
#include <cmath>

#include "core/check.h"

namespace ttf::schedules::sequence {
namespace {

// The detections of one sensor: the interval since the one before, and the time until the result.
struct Look {
  double since_s = 0.0, until_result_s = 0.0;
};

std::vector<Look> looks_of(const Sequence& sequence, const DetectionTimes& times, int sensor) {
  std::vector<Look> looks;
  Duration now{}, first{}, last{};
  for (const Detection& detection : sequence) {
    const Duration lasts = times.of(detection);
    if (detection.sensor == sensor) {
      if (looks.empty()) first = now;
      looks.push_back({(now - last).seconds(), lasts.seconds()});
      last = now;
    }
    now += lasts;
  }
  TTF_CHECK(!looks.empty(), "sensor {} has no detection", sensor);
  looks.front().since_s = (first + now - last).seconds();
  return looks;
}

// The covariance of position and velocity along one axis.
struct Covariance {
  double position, mixed, velocity;
};

Covariance predicted(const Covariance& p, double d, double q) {
  return {p.position + 2.0 * d * p.mixed + d * d * p.velocity + q * d * d * d / 3.0,
          p.mixed + d * p.velocity + q * d * d / 2.0, p.velocity + q * d};
}

// Joseph's form is not needed: one position is measured, and 1 - gain is exact as r / (p + r).
Covariance updated(const Covariance& p, double r) {
  const double rest = r / (p.position + r);
  return {rest * p.position, rest * p.mixed, p.velocity - p.mixed * p.mixed / (p.position + r)};
}

// Returns the integral of the predicted position's variance from 0 to d.
double integral(const Covariance& p, double d, double q) {
  return d * (p.position + d * (p.mixed + d * (p.velocity / 3.0 + d * q / 12.0)));
}

ExpectedError error_of(const std::vector<Look>& looks, const TrackingModel& model) {
  const double q = model.process_noise, r = model.sigma * model.sigma;
  double frame = 0.0;
  for (const Look& look : looks) frame += look.since_s;
  // Begins where the velocity is hardly known: from above, the covariance falls to its limit.
  Covariance p{r, 0.0, r / (frame * frame) + q * frame};
  ExpectedError error;
  constexpr int kMostFrames = 100'000;
  constexpr double kSettled = 1e-11;
  for (int i = 0; i < kMostFrames; ++i) {
    const Covariance before = p;
    error = {};
    for (std::size_t k = 0; k < looks.size(); ++k) {
      p = updated(predicted(p, looks[k].since_s, q), r);
      const Look& next = looks[(k + 1) % looks.size()];
      const double from = looks[k].until_result_s, to = next.since_s + next.until_result_s;
      error.mean += integral(p, to, q) - integral(p, from, q);
      error.worst = std::max(error.worst, predicted(p, to, q).position);
    }
    const auto settled = [](double a, double b) { return std::abs(a - b) <= kSettled * std::abs(a); };
    if (settled(p.position, before.position) && settled(p.mixed, before.mixed) && settled(p.velocity, before.velocity))
      break;
  }
  error.mean /= frame;
  return error;
}

}  // namespace

std::vector<ExpectedError> expected_errors(const Sequence& sequence, const DetectionTimes& times,
                                           const TrackingModel& model) {
  TTF_CHECK(model.process_noise > 0.0 && model.sigma > 0.0, "{} and {}", model.process_noise, model.sigma);
  std::vector<ExpectedError> errors;
  for (int sensor = 0; sensor < static_cast<int>(times.primary.size()); ++sensor)
    errors.push_back(error_of(looks_of(sequence, times, sensor), model));
  return errors;
}

std::vector<BoundChoice> choices(const FrameRequest& request, const DetectionTimes& times, const TrackingModel& model,
                                 double share) {
  TTF_CHECK(!request.interest.empty() && request.secondary > Duration{}, "no secondary detections");
  const int most = free_slots(request);
  const int others = request.sensors - static_cast<int>(request.interest.size());
  std::vector<BoundChoice> all;
  for (int m = 0; m <= most; ++m) {
    BoundChoice& choice = all.emplace_back();
    choice.secondaries = m;
    FrameRequest smaller = request;
    // kText takes one secondary detection more than fits, as soon as any time is free.
    const int full = request.slots == SlotRule::kText ? m - 1 : m;
    if (m > 0) choice.least_bound = request.primaries + request.secondary * full;
    smaller.bound = choice.least_bound;
    if (m == 1 && request.slots == SlotRule::kText) smaller.bound += Duration{1};
    choice.sequence = generated(smaller);
    const std::vector<ExpectedError> errors = expected_errors(choice.sequence, times, model);
    for (int sensor = 0; sensor < request.sensors; ++sensor) {
      const double mean = errors[static_cast<std::size_t>(sensor)].mean;
      if (std::ranges::find(request.interest, sensor) != request.interest.end())
        choice.interest += mean / static_cast<double>(request.interest.size());
      else
        choice.others += mean / others;
    }
    choice.cost = others == 0 ? choice.interest : share * choice.interest + (1.0 - share) * choice.others;
  }
  return all;
}

const BoundChoice& best(const std::vector<BoundChoice>& choices) {
  return *std::ranges::min_element(choices, {}, &BoundChoice::cost);
}

}  // namespace ttf::schedules::sequence
