#include "evaluation/accuracy/drive_measures.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "evaluation/accuracy/closest_pairs.h"
#include "fusion/metrics/chi_square.h"

namespace ttf::evaluation::accuracy {

void AgeStatistics::add(Duration age) {
  ++count;
  sum += age;
  worst = std::max(worst, age);
}

// The reference itself may be off by metres.
DriveMeasures::DriveMeasures(TrueTime from, double gate_m) : from_(from), gate_(gate_m), reference_(2.0 * gate_m) {}

void DriveMeasures::on(const recording::records::FusionInput& input) {
  ++summary_.received;
  // A fusion node whose clock has gone back has started anew, and received nothing yet.
  if (input.stamp.global < receiving_) newest_received_.reset();
  receiving_ = input.stamp.global;
  // Lists that a fusion step takes in together have no order among themselves.
  if (input.step != receiving_step_) {
    receiving_step_ = input.step;
    newest_before_ = newest_received_;
  }
  if (newest_before_ && input.measured < *newest_before_) ++summary_.out_of_sequence;
  newest_received_ = newest_received_ ? std::max(*newest_received_, input.measured) : input.measured;
}

// Until something else becomes of it. A fusion node that restarts has forgotten what it held.
void DriveMeasures::note_held(const recording::records::ListFused& list) {
  const auto known = std::find_if(held_.begin(), held_.end(), [&](const Held& held) {
    return held.id == list.id && held.measured == list.measured;
  });
  if (list.disposition == recording::records::Disposition::kHeld) {
    if (known != held_.end()) return;
    held_.push_back({list.id, list.measured, list.stamp.global});
    if (held_.size() > kMostHeld) held_.pop_front();
  } else if (known != held_.end() && list.disposition != recording::records::Disposition::kDuplicate) {
    if (list.stamp.global >= known->since) summary_.held_for.add(list.stamp.global - known->since);
    held_.erase(known);
  }
}

void DriveMeasures::on(const recording::records::ListFused& fused) {
  note_held(fused);
  switch (fused.disposition) {
    case recording::records::Disposition::kFused: ++summary_.fused; break;
    case recording::records::Disposition::kFusedLate: ++summary_.fused_late; break;
    case recording::records::Disposition::kHeld: ++summary_.held; return;
    case recording::records::Disposition::kDroppedTooOld: ++summary_.dropped; return;
    case recording::records::Disposition::kDuplicate: ++summary_.duplicates; return;
  }
  const Duration age = fused.stamp.global - fused.measured;
  summary_.age_fused.add(age);
  summary_.age_fused_by_sensor[fused.id.sensor].add(age);
  const TrueTime measured = recording::records::true_time_of(fused.stamp, fused.measured);
  const auto [newest, first] = newest_fused_.try_emplace(fused.id.sensor, Fused{fused.id, measured});
  if (!first && measured > newest->second.measured) newest->second = {fused.id, measured};
}

void DriveMeasures::on(const recording::records::TrackState& track) {
  if (!track.predicted_for_image) return;
  Predicted& predicted = predicted_.emplace_back();
  std::copy(track.state.begin(), track.state.end(), predicted.state.begin());
  std::copy(track.covariance.begin(), track.covariance.end(), predicted.covariance.begin());
}

// An image's predictions are reported before it, one an object. Where a torn log lost some, they are not to be told
// apart.
void DriveMeasures::on(const recording::records::ImageWritten& image) {
  if (predicted_.size() != image.objects.size()) predicted_.clear();
  Image& made = images_.emplace_back();
  made.sequence = image.sequence;
  made.predicted = std::move(predicted_);
  for (const MeasurementId& id : image.newest)
    if (const auto newest = newest_fused_.find(id.sensor); newest != newest_fused_.end() && newest->second.id == id)
      made.newest.push_back(newest->second);
  predicted_.clear();
  while (images_.size() > 8) images_.pop_front();
}

// The last of this number: a fusion node that restarts counts its images anew.
const DriveMeasures::Image* DriveMeasures::image_of(std::uint32_t sequence) const {
  const auto last =
      std::find_if(images_.rbegin(), images_.rend(), [&](const Image& image) { return image.sequence == sequence; });
  return last == images_.rend() ? nullptr : &*last;
}

void DriveMeasures::on(const recording::records::FeatureUsed& used) {
  if (pending_) {
    judge(*pending_);
    pending_.reset();
  }
  if (used.stamp.true_time < from_) return;
  ++summary_.uses;
  if (used.stale) ++summary_.stale_uses;
  if (const Image* image = used.stale ? nullptr : image_of(used.image_sequence))
    judge_age(*image, used.stamp.true_time);
  Use use{used.stamp.true_time, used.image_sequence, used.fresh, {}};
  bool warned = false;
  for (const recording::records::FeatureObject& object : used.objects) {
    const recording::records::ImageObject& image = object.image;
    use.objects.push_back(
        {image.x, image.y, image.speed * std::cos(image.heading), image.speed * std::sin(image.heading)});
    warned |= object.warning;
  }
  if (warned) ++summary_.warnings;
  reference_.use(use.at, use.objects);
  pending_ = std::move(use);
}

void DriveMeasures::judge_age(const Image& image, TrueTime used) {
  if (image.newest.empty()) return;
  Duration oldest = used - image.newest.front().measured, youngest = oldest;
  for (const Fused& newest : image.newest) {
    const Duration age = used - newest.measured;
    summary_.age_used.add(age);
    summary_.age_used_by_sensor[newest.id.sensor].add(age);
    oldest = std::max(oldest, age);
    youngest = std::min(youngest, age);
  }
  summary_.age_used_oldest.add(oldest);
  summary_.age_used_newest.add(youngest);
}

void DriveMeasures::on(const recording::records::TruthState& truth) {
  if (!truth_.empty() && truth_.front().at != truth.at) {
    if (pending_ && truth_.front().at == pending_->at) {
      judge(*pending_);
      pending_.reset();
    }
    truth_.clear();
  }
  // Once for every node that recorded it at that instant: the same truth, on other clocks.
  if (!truth_.empty() && truth_.front().node != truth.node) return;
  truth_.push_back(truth);
}

void DriveMeasures::on(const recording::records::ReferenceFix& fix) { reference_.fix(fix); }

void DriveMeasures::judge(const Use& use) {
  if (truth_.empty() || truth_.front().at != use.at) return;
  std::vector<PlanePosition> truth, objects;
  for (const recording::records::TruthState& state : truth_) truth.push_back({state.x, state.y});
  for (const PlaneEstimate& object : use.objects) objects.push_back({object.x, object.y});
  const std::vector<TruthPair> pairs = closest_pairs(truth, objects, gate_);
  summary_.matched += pairs.size();
  summary_.missed += truth.size() - pairs.size();
  summary_.spurious += objects.size() - pairs.size();
  // An image used again was predicted to its first use: its covariance says nothing about now.
  const Image* image = image_of(use.image_sequence);
  const bool consistency = use.fresh && image != nullptr && image->predicted.size() == use.objects.size();
  for (const TruthPair& pair : pairs) {
    const recording::records::TruthState& state = truth_[pair.truth];
    const PlaneEstimate& estimate = use.objects[pair.estimate];
    const double errors[] = {estimate.x - state.x, estimate.y - state.y,
                             estimate.vx - state.speed * std::cos(state.heading),
                             estimate.vy - state.speed * std::sin(state.heading)};
    for (std::size_t k = 0; k < 4; ++k) squares_[k] += errors[k] * errors[k];
    if (consistency) judge_consistency(image->predicted[pair.estimate], state);
  }
}

// The prediction as the filter has it, with its full covariance, which the image rounds and shortens.
void DriveMeasures::judge_consistency(const Predicted& predicted, const recording::records::TruthState& truth) {
  Eigen::Vector4d error;
  error << predicted.state[0] - truth.x, predicted.state[1] - truth.y,
      predicted.state[2] - truth.speed * std::cos(truth.heading),
      predicted.state[3] - truth.speed * std::sin(truth.heading);
  Eigen::Matrix4d covariance;
  for (int r = 0; r < 4; ++r)
    for (int c = 0; c < 4; ++c) covariance(r, c) = predicted.covariance[static_cast<std::size_t>(6 * r + c)];
  nees_sum_ += error.dot(covariance.ldlt().solve(error));
  ++summary_.nees_samples;
}

DriveSummary DriveMeasures::finish() {
  if (pending_) judge(*pending_);
  pending_.reset();
  summary_.reference_compared = reference_.compared();
  summary_.reference_weights = reference_.weights();
  summary_.position_rmse_reference = reference_.position_rmse();
  summary_.velocity_rmse_reference = reference_.velocity_rmse();
  if (summary_.matched > 0) {
    const auto n = static_cast<double>(summary_.matched);
    for (std::size_t k = 0; k < 4; ++k) summary_.rmse_truth[k] = std::sqrt(squares_[k] / n);
    summary_.position_rmse_truth = std::hypot(summary_.rmse_truth[0], summary_.rmse_truth[1]);
    summary_.velocity_rmse_truth = std::hypot(summary_.rmse_truth[2], summary_.rmse_truth[3]);
  }
  if (summary_.nees_samples > 0) {
    const auto samples = static_cast<double>(summary_.nees_samples);
    summary_.nees = nees_sum_ / samples;
    summary_.nees_low = fusion::metrics::chi_square_quantile(0.025, 4.0 * samples) / samples;
    summary_.nees_high = fusion::metrics::chi_square_quantile(0.975, 4.0 * samples) / samples;
  }
  return summary_;
}

}  // namespace ttf::evaluation::accuracy
