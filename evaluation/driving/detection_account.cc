#include "evaluation/driving/detection_account.h"

#include <algorithm>
#include <cmath>

namespace ttf::evaluation::driving {

void Spread::add(Duration duration) {
  const double seconds = duration.seconds();
  if (count_++ == 0) first_ = seconds;
  const double off = seconds - first_;
  sum_ += off;
  squares_ += off * off;
}
double Spread::mean() const { return count_ == 0 ? kNone : first_ + sum_ / static_cast<double>(count_); }
double Spread::deviation() const {
  if (count_ < 2) return kNone;
  const double n = static_cast<double>(count_);
  return std::sqrt(std::max(0.0, squares_ - sum_ * sum_ / n) / (n - 1.0));
}

void DetectionAccount::on(const recording::records::DetectionMade& detection) {
  if (detection.begin < from_) return;
  ++(detection.secondary ? findings_.secondary : findings_.primary);
  Camera& camera = cameras_[index_of(detection.id.sensor)];
  ++camera.detections;
  if (camera.last) camera.intervals.add(detection.begin - *camera.last);
  camera.last = detection.begin;
}

void DetectionAccount::on(const recording::records::SequencePlanned& planned) {
  const TrueTime at = planned.stamp.true_time;
  if (at < from_) return;
  if (frame_) findings_.frames.add(at - *frame_);
  frame_ = at;
}

std::optional<DetectionFindings> DetectionAccount::finish() const {
  if (findings_.primary + findings_.secondary == 0) return std::nullopt;
  DetectionFindings found = findings_;
  const auto most = std::ranges::max_element(cameras_, {}, &Camera::detections);
  found.camera = static_cast<SensorId>(most - cameras_.begin());
  found.intervals = most->intervals;
  return found;
}

}  // namespace ttf::evaluation::driving
