#include "report/drive/series.h"

#include <algorithm>
#include <cmath>

#include "fusion/metrics/object_pairs.h"
#include "report/drawing/log_limits.h"

namespace ttf::report::drive {
namespace {

constexpr std::size_t kImagesKept = 8;

double seconds_of(TrueTime t) { return static_cast<double>(t.ns) * 1e-9; }

}  // namespace

void DriveSeriesSink::on(const recording::records::ListFused& r) {
  const bool fused = r.disposition == recording::records::Disposition::kFused ||
                     r.disposition == recording::records::Disposition::kFusedLate;
  if (!fused || !drawing::possible(r.stamp.global.ns) || !drawing::possible(r.measured.ns) ||
      !drawing::possible(r.stamp.true_time))
    return;
  series_.age_fused[r.id.sensor].push_back(in_ms(r.stamp.global - r.measured));
  const TrueTime measured = recording::records::true_time_of(r.stamp, r.measured);
  const auto [newest, first] = newest_fused_.try_emplace(r.id.sensor, Fused{r.id, measured});
  if (!first && measured > newest->second.measured) newest->second = {r.id, measured};
}

void DriveSeriesSink::on(const recording::records::ImageWritten& r) {
  Image& image = images_.emplace_back();
  image.sequence = r.sequence;
  for (const MeasurementId& id : r.newest)
    if (const auto newest = newest_fused_.find(id.sensor); newest != newest_fused_.end() && newest->second.id == id)
      image.newest.push_back(newest->second);
  while (images_.size() > kImagesKept) images_.pop_front();
}

void DriveSeriesSink::on(const recording::records::FeatureUsed& r) {
  if (pending_) judge(*pending_);
  pending_.reset();
  if (r.stale || !drawing::possible(r.stamp.true_time)) return;
  judge_age(r.image_sequence, r.stamp.true_time);
  pending_ = Use{r.stamp.true_time, {}};
  for (const recording::records::FeatureObject& object : r.objects) {
    const recording::records::ImageObject& image = object.image;
    pending_->objects.push_back(
        {image.x, image.y, image.speed * std::cos(image.heading), image.speed * std::sin(image.heading)});
  }
}

void DriveSeriesSink::judge_age(std::uint32_t sequence, TrueTime used) {
  const auto image =
      std::find_if(images_.rbegin(), images_.rend(), [&](const Image& one) { return one.sequence == sequence; });
  if (image == images_.rend() || image->newest.empty()) return;
  Duration newest = used - image->newest.front().measured, oldest = newest;
  for (const Fused& one : image->newest) {
    const Duration age = used - one.measured;
    series_.age_used[one.id.sensor].push_back(in_ms(age));
    newest = std::min(newest, age);
    oldest = std::max(oldest, age);
  }
  series_.newest_age.push_back({seconds_of(used), in_ms(newest)});
  series_.oldest_age.push_back({seconds_of(used), in_ms(oldest)});
}

void DriveSeriesSink::on(const recording::records::TruthState& r) {
  if (!truth_.empty() && truth_at_ != r.at) {
    if (pending_ && truth_at_ == pending_->at) {
      judge(*pending_);
      pending_.reset();
    }
    truth_.clear();
  }
  if (!truth_.empty() && truth_node_ != r.node) return;  // another node recorded the same truth
  truth_at_ = r.at;
  truth_node_ = r.node;
  truth_.push_back({r.x, r.y, r.speed * std::cos(r.heading), r.speed * std::sin(r.heading)});
}

void DriveSeriesSink::judge(const Use& use) {
  if (truth_.empty() || truth_at_ != use.at) return;
  const std::vector<fusion::metrics::Point> truths(truth_.begin(), truth_.end()),
      objects(use.objects.begin(), use.objects.end());
  double position = 0.0, velocity = 0.0;
  const std::vector<fusion::metrics::ObjectPair> matched = fusion::metrics::object_pairs(truths, objects, gate_m_);
  for (const fusion::metrics::ObjectPair& pair : matched) {
    const State &truth = truth_[pair.truth], &object = use.objects[pair.estimate];
    const double distance = fusion::metrics::distance_m(truth, object), vx = object.vx - truth.vx,
                 vy = object.vy - truth.vy;
    position += distance * distance;
    velocity += vx * vx + vy * vy;
  }
  const std::uint64_t pairs = matched.size();
  series_.matched += pairs;
  series_.missed += truth_.size() - pairs;
  series_.spurious += use.objects.size() - pairs;
  if (pairs == 0) return;
  const double t = seconds_of(use.at), n = static_cast<double>(pairs);
  series_.position_error.push_back({t, std::sqrt(position / n)});
  series_.velocity_error.push_back({t, std::sqrt(velocity / n)});
}

void DriveSeriesSink::on(const recording::records::PrecisionSample& r) {
  if (drawing::possible(r.at)) series_.precision.push_back({seconds_of(r.at), in_us(r.precision)});
}

void DriveSeriesSink::on(const recording::records::ClockCorrected& r) {
  if (drawing::possible(r.stamp.true_time) && !r.offset_missing)
    series_.offset_corrections[r.stamp.node].push_back(
        {seconds_of(r.stamp.true_time), static_cast<double>(r.offset_microticks)});
}

void DriveSeriesSink::on(const recording::records::SlotProblem& r) { ++series_.slot_problems[r.stamp.node][r.status]; }

void DriveSeriesSink::on(const recording::records::TaskRun& r) {
  if (drawing::possible(r.end.true_time)) series_.end_s = std::max(series_.end_s, seconds_of(r.end.true_time));
  if (!r.deadline_met) ++series_.deadlines_missed[{r.start.node, r.task}];
}

void DriveSeriesSink::on(const recording::records::GuardianIntervention& r) {
  ++series_.guardian[std::string(r.why) + (r.cut ? ": cut" : ": blocked")];
}

DriveSeries DriveSeriesSink::finish() {
  if (pending_) judge(*pending_);
  pending_.reset();
  return std::move(series_);
}

std::vector<TimedValue> thinned(const std::vector<TimedValue>& all, std::size_t most) {
  if (all.size() <= most) return all;
  const std::size_t group = (all.size() + most - 1) / most;
  std::vector<TimedValue> some;
  for (std::size_t i = 0; i < all.size(); i += group) {
    const auto begin = all.begin() + static_cast<std::ptrdiff_t>(i);
    const auto end = all.begin() + static_cast<std::ptrdiff_t>(std::min(i + group, all.size()));
    some.push_back(*std::max_element(
        begin, end, [](const TimedValue& a, const TimedValue& b) { return std::abs(a.value) < std::abs(b.value); }));
  }
  return some;
}

}  // namespace ttf::report::drive
