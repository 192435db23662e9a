#include "experiments/measures.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "fusion/metrics.h"

namespace ttf::experiments {

void AgeStatistics::add(Duration age) {
  ++count;
  sum += age;
  worst = std::max(worst, age);
}

DriveMeasures::DriveMeasures(TrueTime from, double gate_m) : from_(from), gate_(gate_m) {}

void DriveMeasures::on(const records::FusionInput& input) {
  ++summary_.received;
  // Lists that a fusion step takes in together have no order among themselves.
  if (input.step != receiving_step_) {
    receiving_step_ = input.step;
    newest_before_ = newest_received_;
  }
  if (newest_before_ && input.measured < *newest_before_) ++summary_.out_of_sequence;
  newest_received_ = newest_received_ ? std::max(*newest_received_, input.measured) : input.measured;
}

void DriveMeasures::on(const records::ListFused& fused) {
  switch (fused.disposition) {
    case records::Disposition::kFused: ++summary_.fused; break;
    case records::Disposition::kFusedLate: ++summary_.fused_late; break;
    case records::Disposition::kHeld: ++summary_.held; return;
    case records::Disposition::kDroppedTooOld: ++summary_.dropped; return;
    case records::Disposition::kDuplicate: ++summary_.duplicates; return;
  }
  const Duration age = fused.stamp.global - fused.measured;
  summary_.age_fused.add(age);
  summary_.age_fused_by_sensor[fused.id.sensor].add(age);
  measured_[fused.id] = fused.measured;
  while (measured_.size() > 256) {
    // Keep memory flat: what is far behind is in no image any more.
    const auto oldest = std::min_element(measured_.begin(), measured_.end(),
                                         [](const auto& a, const auto& b) { return a.second < b.second; });
    measured_.erase(oldest);
  }
}

void DriveMeasures::on(const records::TrackState& track) {
  if (!track.predicted_for_image) return;
  if (!predicted_.empty() && predicted_.front().valid_at < track.valid_at - Duration::milliseconds(500))
    std::erase_if(predicted_, [&](const Predicted& p) { return p.valid_at < track.valid_at; });
  Predicted predicted{track.valid_at, {}, {}};
  std::copy(track.state.begin(), track.state.end(), predicted.state.begin());
  std::copy(track.covariance.begin(), track.covariance.end(), predicted.covariance.begin());
  predicted_.push_back(predicted);
}

void DriveMeasures::on(const records::ImageWritten& image) {
  newest_[image.sequence].assign(image.newest.begin(), image.newest.end());
  while (newest_.size() > 8) newest_.erase(newest_.begin());
}

void DriveMeasures::on(const records::FeatureUsed& used) {
  if (pending_) {
    judge(*pending_);
    pending_.reset();
  }
  if (used.stamp.true_time < from_) return;
  ++summary_.uses;
  if (const auto newest = newest_.find(used.image_sequence); newest != newest_.end())
    for (const MeasurementId& id : newest->second)
      if (const auto measured = measured_.find(id); measured != measured_.end()) {
        const Duration age = used.stamp.global - measured->second;
        summary_.age_used.add(age);
        summary_.age_used_by_sensor[id.sensor].add(age);
      }
  Use use{used.stamp.true_time, used.image_valid_at, {}};
  bool warned = false;
  for (const records::FeatureObject& object : used.objects) {
    const records::ImageObject& image = object.image;
    use.objects.push_back({image.x, image.y, image.speed * std::cos(image.heading),
                           image.speed * std::sin(image.heading)});
    warned |= object.warning;
  }
  if (warned) ++summary_.warnings;
  pending_ = std::move(use);
}

void DriveMeasures::on(const records::TruthState& truth) {
  if (!truth_.empty() && truth_.front().at != truth.at) {
    if (pending_ && truth_.front().at == pending_->at) {
      judge(*pending_);
      pending_.reset();
    }
    truth_.clear();
  }
  truth_.push_back(truth);
}

void DriveMeasures::on(const records::ReferenceFix& fix) { fixes_.push_back(fix); }

// Pairs closest first; each true object and each image object at most once.
void DriveMeasures::judge(const Use& use) {
  if (truth_.empty() || truth_.front().at != use.at) return;
  struct Pair {
    double distance;
    std::size_t truth, object;
  };
  std::vector<Pair> pairs;
  for (std::size_t t = 0; t < truth_.size(); ++t)
    for (std::size_t o = 0; o < use.objects.size(); ++o) {
      const double distance = std::hypot(truth_[t].x - use.objects[o].x, truth_[t].y - use.objects[o].y);
      if (distance <= gate_) pairs.push_back({distance, t, o});
    }
  std::sort(pairs.begin(), pairs.end(), [](const Pair& a, const Pair& b) {
    if (a.distance != b.distance) return a.distance < b.distance;
    return a.truth != b.truth ? a.truth < b.truth : a.object < b.object;
  });
  std::vector<bool> truth_taken(truth_.size()), object_taken(use.objects.size());
  std::uint64_t matched = 0;
  for (const Pair& pair : pairs) {
    if (truth_taken[pair.truth] || object_taken[pair.object]) continue;
    truth_taken[pair.truth] = object_taken[pair.object] = true;
    ++matched;
    const records::TruthState& truth = truth_[pair.truth];
    const Estimate& estimate = use.objects[pair.object];
    const double errors[] = {estimate.x - truth.x, estimate.y - truth.y,
                             estimate.vx - truth.speed * std::cos(truth.heading),
                             estimate.vy - truth.speed * std::sin(truth.heading)};
    for (std::size_t k = 0; k < 4; ++k) squares_[k] += errors[k] * errors[k];
  }
  summary_.matched += matched;
  summary_.missed += truth_.size() - matched;
  summary_.spurious += use.objects.size() - matched;
  judge_nees(use);
  if (!fixes_.empty()) reference_uses_.push_back({use.at, use.objects});
}

// The prediction that was valid at this use, with its full covariance, against the truth nearest to it.
void DriveMeasures::judge_nees(const Use& use) {
  for (const Predicted& predicted : predicted_) {
    if (predicted.valid_at != use.image_valid_at) continue;
    const records::TruthState* nearest = nullptr;
    double best = gate_;
    for (const records::TruthState& truth : truth_) {
      const double distance = std::hypot(truth.x - predicted.state[0], truth.y - predicted.state[1]);
      if (distance < best) {
        best = distance;
        nearest = &truth;
      }
    }
    if (nearest == nullptr) continue;
    Eigen::Vector4d error;
    error << predicted.state[0] - nearest->x, predicted.state[1] - nearest->y,
        predicted.state[2] - nearest->speed * std::cos(nearest->heading),
        predicted.state[3] - nearest->speed * std::sin(nearest->heading);
    Eigen::Matrix4d covariance;
    for (int r = 0; r < 4; ++r)
      for (int c = 0; c < 4; ++c) covariance(r, c) = predicted.covariance[static_cast<std::size_t>(6 * r + c)];
    nees_sum_ += error.dot(covariance.ldlt().solve(error));
    ++summary_.nees_samples;
  }
}

// The reference at a use: its fixes on either side, interpolated; its velocity is their difference quotient.
void DriveMeasures::judge_references() {
  double position = 0.0, velocity = 0.0;
  for (const ReferenceUse& use : reference_uses_) {
    const auto after = std::find_if(fixes_.begin(), fixes_.end(),
                                    [&](const records::ReferenceFix& fix) { return fix.measured_true >= use.at; });
    if (after == fixes_.begin() || after == fixes_.end()) continue;
    const records::ReferenceFix& b = *after;
    const records::ReferenceFix& a = *(after - 1);
    const double h = (b.measured_true - a.measured_true).seconds();
    if (h <= 0.0) continue;
    const double s = (use.at - a.measured_true).seconds() / h;
    const double x = a.x + s * (b.x - a.x), y = a.y + s * (b.y - a.y);
    const Estimate* nearest = nullptr;
    double best = 2.0 * gate_;   // the reference itself may be off by metres
    for (const Estimate& estimate : use.objects)
      if (const double distance = std::hypot(estimate.x - x, estimate.y - y); distance < best) {
        best = distance;
        nearest = &estimate;
      }
    if (nearest == nullptr) continue;
    const double evx = nearest->vx - (b.x - a.x) / h, evy = nearest->vy - (b.y - a.y) / h;
    position += best * best;
    velocity += evx * evx + evy * evy;
    ++summary_.reference_compared;
  }
  const auto n = static_cast<double>(std::max<std::uint64_t>(1, summary_.reference_compared));
  summary_.position_rmse_reference = std::sqrt(position / n);
  summary_.velocity_rmse_reference = std::sqrt(velocity / n);
}

DriveSummary DriveMeasures::finish() {
  if (pending_) judge(*pending_);
  pending_.reset();
  judge_references();
  const auto n = static_cast<double>(std::max<std::uint64_t>(1, summary_.matched));
  for (std::size_t k = 0; k < 4; ++k) summary_.rmse_truth[k] = std::sqrt(squares_[k] / n);
  summary_.position_rmse_truth = std::hypot(summary_.rmse_truth[0], summary_.rmse_truth[1]);
  summary_.velocity_rmse_truth = std::hypot(summary_.rmse_truth[2], summary_.rmse_truth[3]);
  if (summary_.nees_samples > 0) {
    const auto samples = static_cast<double>(summary_.nees_samples);
    summary_.nees = nees_sum_ / samples;
    summary_.nees_low = fusion::chi_square_quantile(0.025, 4.0 * samples) / samples;
    summary_.nees_high = fusion::chi_square_quantile(0.975, 4.0 * samples) / samples;
  }
  return summary_;
}

}  // namespace ttf::experiments
