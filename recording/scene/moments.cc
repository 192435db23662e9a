#include "recording/scene/moments.h"

#include <cmath>
#include <utility>

namespace ttf::recording::scene {

void Moments::finish() {
  finish_truth();
  finish_list();
}

// Records come in the order of time: the truth and the list of another instant are complete.
void Moments::come_to(TrueTime at) {
  if (!truth_.empty() && truth_.front().at != at) finish_truth();
  if (list_ && list_->stamp.true_time != at) finish_list();
  reached(shown(at));
}

// Every node that recorded the truth of an instant has the same: the first node's is kept.
void Moments::on(const records::TruthState& r) {
  come_to(r.at);
  if (truth_.empty() || truth_.front().node == r.node) truth_.push_back(r);
}

void Moments::on(const records::EgoTruth& r) {
  come_to(r.at);
  ego_ = r;
}

// Odometry that has stopped is coasted on.
void Moments::on(const records::OdometryTaken& r) {
  come_to(r.stamp.true_time);
  if (r.stopped || !std::isfinite(r.speed) || !std::isfinite(r.yaw_rate)) return;
  own_ = OwnMotion{r.speed, r.yaw_rate};
  odometry(r.id.sensor);
}

records::EgoTruth Moments::ego() const {
  const bool of_this_instant = ego_ && !truth_.empty() && ego_->at == truth_.front().at;
  return of_this_instant ? *ego_ : records::EgoTruth{};
}

void Moments::finish_truth() {
  if (truth_.empty()) return;
  truth(shown(truth_.front().at), truth_);
  truth_.clear();
}

void Moments::on(const records::ObservationSeen& r) {
  come_to(r.stamp.true_time);
  if (list_ && (list_->id != r.id || list_->stamp.node != r.stamp.node)) finish_list();
  if (!list_) list_ = SeenList{r.stamp, r.id, instant_of(r.stamp, r.measured), {}};
  if (std::isfinite(r.x) && std::isfinite(r.y)) list_->points.push_back({r.x, r.y});
}

void Moments::finish_list() {
  if (list_) list(*std::exchange(list_, std::nullopt));
}

void Moments::on(const records::ReferenceFix& r) {
  come_to(r.measured_true);
  if (std::isfinite(r.x) && std::isfinite(r.y)) fix(shown(r.measured_true), r);
}

void Moments::on(const records::ImageWritten& r) {
  come_to(r.stamp.true_time);
  image(instant_of(r.stamp, r.valid_at), r);
}

void Moments::on(const records::FeatureUsed& r) {
  come_to(r.stamp.true_time);
  use(shown(r.stamp.true_time), r);
}

}  // namespace ttf::recording::scene
