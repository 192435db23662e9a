#include "evaluation/accuracy/reference_judge.h"

#include <cmath>
#include <limits>

namespace ttf::evaluation::accuracy {
namespace {

// A use without a fix by then never gets one: the reference's period and latency are 10 s at most.
constexpr Duration kLongestWait = Duration::milliseconds(20'000);

double root_mean(double squares, std::uint64_t n) {
  return n == 0 ? std::numeric_limits<double>::quiet_NaN() : std::sqrt(squares / static_cast<double>(n));
}

}  // namespace

void ReferenceJudge::fix(const recording::records::ReferenceFix& fix) {
  before_ = after_;
  after_ = fix;
  while (!waiting_.empty() && waiting_.front().at <= fix.measured_true) {
    judge(waiting_.front());
    waiting_.pop_front();
  }
}

void ReferenceJudge::use(TrueTime at, std::span<const PlaneEstimate> estimates) {
  if (!after_) return;  // no fix precedes it
  Use use{at, {estimates.begin(), estimates.end()}};
  if (at <= after_->measured_true) return judge(use);
  waiting_.push_back(std::move(use));
  while (waiting_.front().at + kLongestWait < at) waiting_.pop_front();
}

void ReferenceJudge::judge(const Use& use) {
  if (!before_ || use.at < before_->measured_true) return;
  const recording::records::ReferenceFix &a = *before_, &b = *after_;
  const double h = (b.measured_true - a.measured_true).seconds();
  if (h <= 0.0) return;
  const double s = (use.at - a.measured_true).seconds() / h;
  const double x = a.x + s * (b.x - a.x), y = a.y + s * (b.y - a.y);
  const PlaneEstimate* nearest = nullptr;
  double best = gate_;
  for (const PlaneEstimate& estimate : use.estimates)
    if (const double distance = std::hypot(estimate.x - x, estimate.y - y); distance < best) {
      best = distance;
      nearest = &estimate;
    }
  if (nearest == nullptr) return;
  ++compared_;
  position_squares_ += best * best;
  sums_.squares += (1.0 - s) * (1.0 - s) + s * s;
  sums_.products += 2.0 * s * (1.0 - s);
  sums_.range_squared += nearest->x * nearest->x + nearest->y * nearest->y;
  const double evx = nearest->vx - (a.vx + s * (b.vx - a.vx)), evy = nearest->vy - (a.vy + s * (b.vy - a.vy));
  if (!std::isfinite(evx) || !std::isfinite(evy)) return;
  ++velocities_;
  velocity_squares_ += evx * evx + evy * evy;
}

ReferenceWeights ReferenceJudge::weights() const {
  if (compared_ == 0) return {};
  const auto n = static_cast<double>(compared_);
  return {sums_.squares / n, sums_.products / n, sums_.range_squared / n};
}

double expected_square(const sim::world::ReferenceConfig& reference, const ReferenceWeights& weights) {
  const double calm = 1.0 - reference.excursion_probability;
  const double there = 1.0 - std::pow(calm, reference.excursion_fixes);
  const double same = calm * (1.0 - std::pow(calm, reference.excursion_fixes - 1));
  const double noise = reference.sigma_m * reference.sigma_m, excursion = reference.excursion_m * reference.excursion_m;
  const double alignment = 2.0 * noise / (reference.alignment_baseline_m * reference.alignment_baseline_m);
  return (2.0 * noise + excursion * there) * weights.squares + excursion * same * weights.products +
         alignment * weights.range_squared;
}

double ReferenceJudge::position_rmse() const { return root_mean(position_squares_, compared_); }
double ReferenceJudge::velocity_rmse() const { return root_mean(velocity_squares_, velocities_); }

}  // namespace ttf::evaluation::accuracy
