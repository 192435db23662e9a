#include "evaluation/accuracy/drive_measures.h"

#include <algorithm>
#include <cmath>

#include "fusion/metrics/chi_square.h"

namespace ttf::evaluation::accuracy {

void AgeStatistics::add(Duration age) {
  ++count;
  sum += age;
  worst = std::max(worst, age);
}

// Twice the gate: the reference itself may be off by metres.
DriveMeasures::DriveMeasures(TrueTime from, double gate_m, std::optional<TrueTime> until)
    : ImageUses(gate_m), from_(from), until_(until), reference_(2.0 * gate_m) {}

void DriveMeasures::on(const recording::records::FusionInput& input) {
  ++summary_.received;
  // If its clock has gone back, the fusion node was restarted and has received no list yet.
  if (input.stamp.global < receiving_) newest_received_.reset();
  receiving_ = input.stamp.global;
  // Lists of one fusion step have no order among themselves.
  if (input.step != receiving_step_) {
    receiving_step_ = input.step;
    newest_before_ = newest_received_;
  }
  if (newest_before_ && input.measured < *newest_before_) ++summary_.out_of_sequence;
  newest_received_ = newest_received_ ? std::max(*newest_received_, input.measured) : input.measured;
}

// Keeps a held list until its fate is known. A restarted fusion node has forgotten its held lists.
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

void DriveMeasures::on(const recording::records::ListFused& list) {
  note_held(list);
  switch (list.disposition) {
    case recording::records::Disposition::kFused: ++summary_.fused; break;
    case recording::records::Disposition::kFusedLate: ++summary_.fused_late; break;
    case recording::records::Disposition::kHeld: ++summary_.held; break;
    case recording::records::Disposition::kDroppedTooOld: ++summary_.dropped; break;
    case recording::records::Disposition::kDuplicate: ++summary_.duplicates; break;
  }
  ImageUses::on(list);
}

void DriveMeasures::fused(SensorId sensor, Duration age) {
  summary_.age_fused.add(age);
  summary_.age_fused_by_sensor[sensor].add(age);
}

void DriveMeasures::on(const recording::records::ReferenceFix& fix) { reference_.fix(fix); }

bool DriveMeasures::used(const recording::records::FeatureUsed& use, std::span<const PlaneEstimate> objects,
                         std::span<const SensorAge> ages) {
  if (use.stamp.true_time < from_ || (until_ && use.stamp.true_time > *until_)) return false;
  ++summary_.uses;
  summary_.stale_uses += use.stale;
  summary_.warnings += std::any_of(use.objects.begin(), use.objects.end(),
                                   [](const recording::records::FeatureObject& object) { return object.warning; });
  note_ages(ages);
  reference_.use(use.stamp.true_time, objects);
  return true;
}

void DriveMeasures::note_ages(std::span<const SensorAge> ages) {
  if (ages.empty()) return;
  Duration oldest = ages.front().age, youngest = oldest;
  for (const auto& [sensor, age] : ages) {
    summary_.age_used.add(age);
    summary_.age_used_by_sensor[sensor].add(age);
    oldest = std::max(oldest, age);
    youngest = std::min(youngest, age);
  }
  summary_.age_used_oldest.add(oldest);
  summary_.age_used_newest.add(youngest);
}

void DriveMeasures::judged(const JudgedUse& use) {
  summary_.matched += use.objects.size();
  summary_.missed += use.missed;
  summary_.spurious += use.spurious;
  for (const UsedObject& object : use.objects) {
    for (std::size_t k = 0; k < 4; ++k) squares_[k] += object.error[k] * object.error[k];
    if (!object.belief) continue;
    nees_sum_ += object.belief->nees;
    ++summary_.nees_samples;
  }
}

DriveSummary DriveMeasures::finish() {
  finish_use();
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
