#include "evaluation/accuracy/drive_measures.h"

#include <algorithm>
#include <cmath>

namespace ttf::evaluation::accuracy {

void AgeStatistics::add(Duration age) {
  ++count;
  sum += age;
  worst = std::max(worst, age);
}

// Twice the gate: the reference itself may be off by metres.
DriveMeasures::DriveMeasures(TrueTime from, double gate_m, std::optional<TrueTime> until,
                             const fusion::metrics::CutOff& cut_off)
    : ImageUses(gate_m), from_(from), until_(until), box_squares_{0, 0, 0, 0, 0, 0, 0}, tracking_(cut_off, gate_m),
      reference_(2.0 * gate_m) {}

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

void DriveMeasures::on(const recording::records::OdometryTaken& odometry) {
  ++(odometry.stopped ? summary_.odometry_stops : summary_.odometry_samples);
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
  const bool judged = is_judged(list.stamp.true_time);
  constexpr std::uint32_t kMost = 1'000'000;  // more than a list can have: a damaged log
  if (judged && list.innovation_degrees > 0 && list.innovation_degrees <= kMost)
    innovations_.add(list.innovation_squares, static_cast<int>(list.innovation_degrees));
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

bool DriveMeasures::is_judged(TrueTime at) const {
  if (at < from_ || (until_ && at > *until_)) return false;
  const std::optional<TrueTime> end = end_ ? end_() : std::nullopt;
  return !end || at <= *end;
}

bool DriveMeasures::used(const recording::records::FeatureUsed& use, std::span<const PlaneEstimate> objects,
                         std::span<const SensorAge> ages) {
  if (!is_judged(use.stamp.true_time)) return false;
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
  summary_.out_of_view += use.out_of_view;
  summary_.shown_out_of_view += use.shown_out_of_view;
  tracking_.judge(use.at, use.truths, use.shown);
  for (const UsedObject& object : use.objects) {
    for (std::size_t k = 0; k < 4; ++k) squares_[k] += object.error[k] * object.error[k];
    note_box(object);
    if (object.belief) note_belief(*object.belief);
  }
}

void DriveMeasures::note_belief(const Belief& belief) {
  nees_.add(belief.nees, 4);
  position_.add(belief.position_nees, 2);
  velocity_.add(belief.velocity_nees, 2);
  for (std::size_t k = 0; k < kQuantities; ++k)
    if (!std::isnan(belief.quantity_nees[k])) quantities_[k].add(belief.quantity_nees[k], 1);
}

OwnJudgement DriveMeasures::own_judgement() const {
  const auto of = [&](Quantity quantity) { return quantities_[static_cast<std::size_t>(quantity)].per_degree(); };
  return {position_.per_degree(), velocity_.per_degree(),      of(Quantity::kHeading),
          of(Quantity::kSpeed),   of(Quantity::kAcceleration), of(Quantity::kLength),
          of(Quantity::kWidth),   innovations_.per_degree(),   innovations_.degrees()};
}

void DriveMeasures::note_box(const UsedObject& object) {
  const auto add = [](double& sum, double error) { sum += error * error; };
  add(box_squares_.face_m, object.box.face_m);
  add(box_squares_.gap_m, object.box.gap_m);
  add(box_squares_.heading_rad, object.box.heading_rad);
  add(box_squares_.speed_mps, object.speed_mps);
  add(box_squares_.acceleration_mps2, object.acceleration_mps2);
  add(box_squares_.length_m, object.box.length_m);
  add(box_squares_.width_m, object.box.width_m);
}

DriveSummary DriveMeasures::finish() {
  finish_use();
  summary_.tracking = tracking_.measures();
  summary_.reference_compared = reference_.compared();
  summary_.reference_weights = reference_.weights();
  summary_.position_rmse_reference = reference_.position_rmse();
  summary_.velocity_rmse_reference = reference_.velocity_rmse();
  if (summary_.matched > 0) {
    const auto n = static_cast<double>(summary_.matched);
    for (std::size_t k = 0; k < 4; ++k) summary_.rmse_truth[k] = std::sqrt(squares_[k] / n);
    summary_.position_rmse_truth = std::hypot(summary_.rmse_truth[0], summary_.rmse_truth[1]);
    summary_.velocity_rmse_truth = std::hypot(summary_.rmse_truth[2], summary_.rmse_truth[3]);
    const auto mean_root = [&](double sum) { return std::sqrt(sum / n); };
    const BoxErrors& sums = box_squares_;
    summary_.box = {mean_root(sums.face_m),
                    mean_root(sums.gap_m),
                    mean_root(sums.heading_rad),
                    mean_root(sums.speed_mps),
                    mean_root(sums.acceleration_mps2),
                    mean_root(sums.length_m),
                    mean_root(sums.width_m)};
  }
  const fusion::metrics::Band band = nees_.band();
  summary_.nees = nees_.mean();
  summary_.nees_samples = nees_.samples();
  summary_.nees_low = band.low;
  summary_.nees_high = band.high;
  summary_.own = own_judgement();
  return summary_;
}

}  // namespace ttf::evaluation::accuracy
