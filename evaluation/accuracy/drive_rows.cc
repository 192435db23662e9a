#include "evaluation/accuracy/drive_rows.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "fusion/metrics/chi_square.h"

namespace ttf::evaluation::accuracy {
namespace {

constexpr double kNoRow = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t kRowImages = 8;
constexpr double kNeesWindows = 25;

// 1, 2 or 5 of some power of ten, at least `least`.
double round_step(double least) {
  const double power = std::pow(10.0, std::floor(std::log10(least)));
  for (const double step : {1.0, 2.0, 5.0})
    if (step * power >= least) return step * power;
  return 10.0 * power;
}

}  // namespace

std::vector<NeesRow> nees_rows(const std::vector<ErrorRow>& errors) {
  std::vector<NeesRow> rows;
  if (errors.empty()) return rows;
  const double begin = static_cast<double>(errors.front().at.ns) * 1e-9,
               end = static_cast<double>(errors.back().at.ns) * 1e-9;
  const double step = end > begin ? round_step((end - begin) / kNeesWindows) : 1.0;
  for (const ErrorRow& error : errors) {
    if (std::isnan(error.nees)) continue;
    const double from = std::floor(static_cast<double>(error.at.ns) * 1e-9 / step) * step;
    if (rows.empty() || rows.back().from_s != from) rows.push_back({from, from + step, 0, 0.0, 0.0, 0.0});
    ++rows.back().samples;
    rows.back().mean += error.nees;
  }
  for (NeesRow& row : rows) {
    const auto n = static_cast<double>(row.samples);
    row.mean /= n;
    row.low = fusion::metrics::chi_square_quantile(0.025, 4.0 * n) / n;
    row.high = fusion::metrics::chi_square_quantile(0.975, 4.0 * n) / n;
  }
  return rows;
}

void DriveRows::add_age(AgeOf of, SensorId sensor, Duration age) {
  std::int64_t bin = age.ns / kAgeBin.ns;
  if (age.ns < 0 && age.ns % kAgeBin.ns != 0) --bin;
  ++ages_[{of, sensor}][bin];
}

void DriveRows::on(const recording::records::ListFused& fused) {
  if (fused.disposition != recording::records::Disposition::kFused &&
      fused.disposition != recording::records::Disposition::kFusedLate)
    return;
  add_age(AgeOf::kFused, fused.id.sensor, fused.stamp.global - fused.measured);
  const TrueTime measured = recording::records::true_time_of(fused.stamp, fused.measured);
  const auto [newest, first] = newest_fused_.try_emplace(fused.id.sensor, fused.id, measured);
  if (!first && measured > newest->second.second) newest->second = {fused.id, measured};
}

void DriveRows::on(const recording::records::TrackState& track) {
  if (!track.predicted_for_image) return;
  Predicted& predicted = predicted_.emplace_back();
  for (std::size_t r = 0; r < 4; ++r) {
    predicted.state[r] = track.state[r];
    for (std::size_t c = 0; c < 4; ++c) predicted.covariance[4 * r + c] = track.covariance[6 * r + c];
  }
}

// An image's predictions are reported before it, one an object. Where a torn log lost some, they are not to be told
// apart.
void DriveRows::on(const recording::records::ImageWritten& image) {
  if (predicted_.size() != image.objects.size()) predicted_.clear();
  Image& made = images_.emplace_back(Image{image.sequence, {}, std::move(predicted_)});
  for (const MeasurementId& id : image.newest)
    if (const auto newest = newest_fused_.find(id.sensor); newest != newest_fused_.end() && newest->second.first == id)
      made.newest.emplace_back(id.sensor, newest->second.second);
  predicted_.clear();
  while (images_.size() > kRowImages) images_.pop_front();
}

const DriveRows::Image* DriveRows::image_of(std::uint32_t sequence) const {
  const auto last =
      std::find_if(images_.rbegin(), images_.rend(), [&](const Image& image) { return image.sequence == sequence; });
  return last == images_.rend() ? nullptr : &*last;
}

void DriveRows::on(const recording::records::FeatureUsed& used) {
  finish();
  const Image* image = used.stale ? nullptr : image_of(used.image_sequence);
  if (image != nullptr)
    for (const auto& [sensor, measured] : image->newest) add_age(AgeOf::kUsed, sensor, used.stamp.true_time - measured);
  Use& use = pending_.emplace(Use{used.stamp.true_time, used.image_sequence, used.fresh, {}});
  for (const recording::records::FeatureObject& object : used.objects)
    use.objects.push_back({object.image.x, object.image.y, object.image.speed * std::cos(object.image.heading),
                           object.image.speed * std::sin(object.image.heading)});
}

void DriveRows::on(const recording::records::TruthState& truth) {
  if (!truth_.empty() && truth_.front().at != truth.at) {
    if (pending_ && truth_.front().at == pending_->at) finish();
    truth_.clear();
  }
  // Once for every node that recorded it at that instant: the same truth, on other clocks.
  if (truth_.empty() || truth_.front().node == truth.node) truth_.push_back(truth);
}

void DriveRows::on(const recording::records::ReferenceFix& fix) {
  if (!referenced_) referenced_ = fix.object;
}

void DriveRows::finish() {
  if (pending_) judge();
  pending_.reset();
}

void DriveRows::judge() {
  if (truth_.empty() || truth_.front().at != pending_->at) return;
  std::vector<PlanePosition> truth, objects;
  for (const recording::records::TruthState& state : truth_) truth.push_back({state.x, state.y});
  for (const auto& object : pending_->objects) objects.push_back({object[0], object[1]});
  const Image* image = image_of(pending_->image);
  const bool predicted = pending_->fresh && image != nullptr && image->predicted.size() == pending_->objects.size();
  for (const TruthPair& pair : closest_pairs(truth, objects, gate_)) {
    const recording::records::TruthState& state = truth_[pair.truth];
    const std::array<double, 4> true_state{state.x, state.y, state.speed * std::cos(state.heading),
                                           state.speed * std::sin(state.heading)};
    ErrorRow& row =
        errors_.emplace_back(ErrorRow{pending_->at, state.object, {}, {kNoRow, kNoRow, kNoRow, kNoRow}, kNoRow});
    Eigen::Vector4d error;
    for (std::size_t k = 0; k < 4; ++k) row.error[k] = pending_->objects[pair.estimate][k] - true_state[k];
    if (!predicted) continue;
    const Predicted& own = image->predicted[pair.estimate];
    const Eigen::Matrix4d covariance = Eigen::Map<const Eigen::Matrix4d>(own.covariance.data()).transpose();
    for (std::size_t k = 0; k < 4; ++k) {
      error(static_cast<Eigen::Index>(k)) = own.state[k] - true_state[k];
      row.sigma[k] = std::sqrt(own.covariance[5 * k]);
    }
    row.nees = error.dot(covariance.ldlt().solve(error));
  }
}

}  // namespace ttf::evaluation::accuracy
