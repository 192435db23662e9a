#include "experiments/sweep/expected_drive.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "drives/drive.h"
#include "evaluation/accuracy/closest_pairs.h"

namespace ttf::experiments::sweep {
namespace {

constexpr double kWorldStep_s = 0.01;  // the world draws once per step (sim/world/world.h)
constexpr std::size_t kMostTruths = 128, kMostSeen = 128, kMostImages = 8;

// Converts the world's noise to white noise: the acceleration along the heading, and across it the turn rate's
// effect at this speed.
PointMotion motion_of(const drives::Scenario& scenario) {
  const sim::world::ObjectConfig& object = scenario.world.objects.front();
  PointMotion motion = PointMotion::known(scenario.tracker.process_noise, scenario.tracker.initial_velocity_sigma);
  const double c = std::cos(object.heading), s = std::sin(object.heading);
  const double along = scenario.world.acceleration_noise, across = scenario.world.yaw_rate_noise * object.speed;
  Eigen::Matrix2d turn;
  turn << c, -s, s, c;
  const Eigen::Vector2d density(along * along * kWorldStep_s, across * across * kWorldStep_s);
  motion.actual = turn * density.asDiagonal() * turn.transpose();
  const Eigen::Vector2d velocity(object.speed * c, object.speed * s);
  motion.actual_velocity = velocity * velocity.transpose();
  return motion;
}

}  // namespace

bool ExpectedError::is_defined(const drives::Scenario& scenario) {
  return scenario.world.objects.size() == 1 &&
         scenario.tracker.motion == fusion::config::MotionModel::kConstantVelocity;
}

ExpectedError::ExpectedError(const drives::Scenario& scenario)
    : from_(drives::evaluation_start(scenario)), motion_(motion_of(scenario)), recursion_(motion_) {}

double ExpectedError::position_mse() const {
  return uses_ == 0 ? std::numeric_limits<double>::quiet_NaN() : sum_ / static_cast<double>(uses_);
}

void ExpectedError::on(const recording::records::TruthState& truth) {
  truth_.push_back(truth);
  if (truth_.size() > kMostTruths) truth_.pop_front();
}

// Truth is recorded when sensors measure, by their own clocks: take the nearest one.
void ExpectedError::on(const recording::records::ObservationSeen& observation) {
  const TrueTime measured = recording::records::true_time_of(observation.stamp, observation.measured);
  const auto off = [&](const recording::records::TruthState& truth) { return std::abs((truth.at - measured).ns); };
  const auto truth =
      std::min_element(truth_.begin(), truth_.end(), [&](const auto& a, const auto& b) { return off(a) < off(b); });
  if (truth == truth_.end()) return;
  const double distance = std::hypot(observation.x - truth->x, observation.y - truth->y);
  if (distance > evaluation::accuracy::kGate_m) return;
  Seen seen{observation.id, observation.measured, distance, {}};
  seen.noise << observation.sxx, observation.sxy, observation.sxy, observation.syy;
  const auto known = std::find_if(seen_.begin(), seen_.end(),
                                  [&](const Seen& one) { return one.id == seen.id && one.measured == seen.measured; });
  if (known == seen_.end()) {
    seen_.push_back(seen);
    if (seen_.size() > kMostSeen) seen_.pop_front();
  } else if (distance < known->distance) {
    *known = seen;
  }
}

void ExpectedError::on(const recording::records::ListFused& list) {
  // A restarted fusion node has forgotten everything, and may count time anew.
  if (list.stamp.global < fusing_) {
    recursion_ = ErrorRecursion(motion_);
    images_.clear();
  }
  fusing_ = list.stamp.global;
  if (list.disposition != recording::records::Disposition::kFused &&
      list.disposition != recording::records::Disposition::kFusedLate)
    return;
  const auto seen = std::find_if(seen_.begin(), seen_.end(),
                                 [&](const Seen& one) { return one.id == list.id && one.measured == list.measured; });
  if (seen == seen_.end()) return;
  recursion_.fuse({seen->measured, seen->noise});
  seen_.erase(seen);
}

void ExpectedError::on(const recording::records::ImageWritten& image) {
  if (recursion_.empty() || image.objects.empty() || image.valid_at < image.newest_measurement) return;
  images_.push_back({image.sequence, recursion_.at(image.valid_at).topLeftCorner<2, 2>().trace()});
  if (images_.size() > kMostImages) images_.pop_front();
}

void ExpectedError::on(const recording::records::FeatureUsed& used) {
  if (used.stamp.true_time < from_ || !used.fresh || used.stale) return;
  const auto image = std::find_if(images_.rbegin(), images_.rend(),
                                  [&](const Image& one) { return one.sequence == used.image_sequence; });
  if (image == images_.rend()) return;
  sum_ += image->square;
  ++uses_;
}

}  // namespace ttf::experiments::sweep
