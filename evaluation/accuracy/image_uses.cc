#include "evaluation/accuracy/image_uses.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "evaluation/accuracy/judged_objects.h"
#include "fusion/metrics/consistency.h"

namespace ttf::evaluation::accuracy {
namespace {

constexpr std::size_t kImagesRemembered = 8;

PlaneEstimate in_the_plane(double x, double y, double speed, double heading) {
  return {x, y, speed * std::cos(heading), speed * std::sin(heading)};
}

template <class Object> Box box_of(const Object& object) {
  return {object.x, object.y, object.heading, object.length, object.width};
}

// A certain belief is none: the motion model has no such quantity.
double squared(const recording::records::Believed& believed, double error) {
  return believed.sigma > 0.0 ? error * error / (believed.sigma * believed.sigma)
                              : std::numeric_limits<double>::quiet_NaN();
}
ByQuantity<double> squares_of(const recording::records::BelievedBox& box, const recording::records::TruthState& is) {
  return {squared(box.heading, std::remainder(box.heading.value - is.heading, 2.0 * std::numbers::pi)),
          squared(box.speed, box.speed.value - is.speed),
          squared(box.acceleration, box.acceleration.value - is.acceleration),
          squared(box.length, box.length.value - is.length), squared(box.width, box.width.value - is.width)};
}

}  // namespace

void ImageUses::on(const recording::records::ListFused& list) {
  if (list.disposition != recording::records::Disposition::kFused &&
      list.disposition != recording::records::Disposition::kFusedLate)
    return;
  fused(list.id.sensor, list.stamp.global - list.measured);
  const TrueTime measured = recording::records::true_time_of(list.stamp, list.measured);
  const auto [newest, first] = newest_fused_.try_emplace(list.id.sensor, Fused{list.id, measured});
  if (!first && measured > newest->second.measured) newest->second = {list.id, measured};
}

void ImageUses::on(const recording::records::TrackState& track) {
  if (!track.predicted_for_image) return;
  Predicted& predicted = predicted_.emplace_back();
  for (std::size_t r = 0; r < 4; ++r) {
    predicted.state[r] = track.state[r];
    for (std::size_t c = 0; c < 4; ++c) predicted.covariance[4 * r + c] = track.covariance[6 * r + c];
  }
  predicted.box = track.box;
}

// An image's predictions are reported before it, one per object. If a torn log lost some, the rest cannot be
// assigned.
void ImageUses::on(const recording::records::ImageWritten& image) {
  if (predicted_.size() != image.objects.size()) predicted_.clear();
  Image& made = images_.emplace_back();
  made.sequence = image.sequence;
  made.predicted = std::move(predicted_);
  for (const MeasurementId& id : image.newest)
    if (const auto newest = newest_fused_.find(id.sensor); newest != newest_fused_.end() && newest->second.id == id)
      made.newest.push_back(newest->second);
  predicted_.clear();
  while (images_.size() > kImagesRemembered) images_.pop_front();
}

// Returns the newest image of this number: a restarted fusion node counts its images anew.
const ImageUses::Image* ImageUses::image_of(std::uint32_t sequence) const {
  const auto last =
      std::find_if(images_.rbegin(), images_.rend(), [&](const Image& image) { return image.sequence == sequence; });
  return last == images_.rend() ? nullptr : &*last;
}

void ImageUses::on(const recording::records::FeatureUsed& used_now) {
  finish_use();
  Use use{used_now.stamp.true_time, used_now.image_sequence, used_now.fresh, {}, {}};
  for (const recording::records::FeatureObject& object : used_now.objects) {
    use.objects.push_back(in_the_plane(object.image.x, object.image.y, object.image.speed, object.image.heading));
    use.images.push_back(object.image);
  }
  std::vector<SensorAge> ages;
  if (const Image* image = used_now.stale ? nullptr : image_of(use.image))
    for (const Fused& newest : image->newest) ages.push_back({newest.id.sensor, use.at - newest.measured});
  if (used(used_now, use.objects, ages)) pending_ = std::move(use);
}

void ImageUses::on(const recording::records::TruthState& truth) {
  if (!truth_.empty() && truth_.front().at != truth.at) {
    if (pending_ && truth_.front().at == pending_->at) finish_use();
    truth_.clear();
  }
  // Every node that recorded the truth of that instant has the same, on its own clocks: keep the first node's.
  if (truth_.empty() || truth_.front().node == truth.node) truth_.push_back(truth);
}

void ImageUses::finish_use() {
  if (pending_) judge(*pending_);
  pending_.reset();
}

void ImageUses::judge(const Use& use) {
  if (truth_.empty() || truth_.front().at != use.at) return;
  std::vector<fusion::metrics::Point> truth, objects;
  std::vector<bool> in_view;
  for (const recording::records::TruthState& state : truth_) {
    truth.push_back({state.x, state.y});
    in_view.push_back(!state.out_of_view);
  }
  for (const PlaneEstimate& object : use.objects) objects.push_back({object.x, object.y});
  const JudgedObjects counted = judged_objects(truth, in_view, objects, gate_);
  JudgedUse result;
  result.at = use.at;
  result.missed = counted.truths.size() - counted.pairs.size();
  result.spurious = counted.shown.size() - counted.pairs.size();
  result.out_of_view = truth.size() - counted.truths.size();
  result.shown_out_of_view = objects.size() - counted.shown.size();
  for (const std::size_t t : counted.truths)
    result.truths.push_back({static_cast<fusion::metrics::Identity>(truth_[t].object), truth[t]});
  for (const std::size_t o : counted.shown)
    result.shown.push_back({static_cast<fusion::metrics::Identity>(use.images[o].track), objects[o]});
  // The predictions of an image hold at its first use.
  const Image* image = use.fresh ? image_of(use.image) : nullptr;
  const bool predicted = image != nullptr && image->predicted.size() == use.objects.size();
  for (const fusion::metrics::ObjectPair& pair : counted.pairs) {
    const recording::records::TruthState& state = truth_[pair.truth];
    const PlaneEstimate is = in_the_plane(state.x, state.y, state.speed, state.heading);
    const PlaneEstimate& shown = use.objects[pair.estimate];
    UsedObject& object = result.objects.emplace_back();
    object.object = state.object;
    object.error = {shown.x - is.x, shown.y - is.y, shown.vx - is.vx, shown.vy - is.vy};
    const recording::records::ImageObject& drawn = use.images[pair.estimate];
    object.box = error_of(box_of(drawn), box_of(state));
    object.speed_mps = drawn.speed - state.speed;
    object.acceleration_mps2 = drawn.acceleration - state.acceleration;
    if (!predicted) continue;
    const Predicted& own = image->predicted[pair.estimate];
    const Eigen::Vector4d error(own.state[0] - is.x, own.state[1] - is.y, own.state[2] - is.vx, own.state[3] - is.vy);
    const Eigen::Matrix4d covariance = Eigen::Map<const Eigen::Matrix4d>(own.covariance.data()).transpose();
    Belief& belief = object.belief.emplace();
    for (std::size_t k = 0; k < 4; ++k) belief.sigma[k] = std::sqrt(own.covariance[5 * k]);
    belief.nees = fusion::metrics::normalised_squared<4>(error, covariance);
    const Eigen::Matrix2d position = covariance.topLeftCorner<2, 2>(), velocity = covariance.bottomRightCorner<2, 2>();
    belief.position_nees = fusion::metrics::normalised_squared<2>(error.head<2>(), position);
    belief.velocity_nees = fusion::metrics::normalised_squared<2>(error.tail<2>(), velocity);
    belief.quantity_nees.fill(std::numeric_limits<double>::quiet_NaN());
    if (own.box) belief.quantity_nees = squares_of(*own.box, state);
  }
  judged(result);
}

}  // namespace ttf::evaluation::accuracy
