#include "bus/dds/ros/outbox.h"

#include <algorithm>

namespace ttf::bus::dds::ros {
namespace {

void count(std::atomic<std::uint64_t>& counter) { counter.fetch_add(1, std::memory_order_relaxed); }

// Appends texts until one has no room. DDS' strings end with a zero, so a text ends at its first zero.
class Texts {
 public:
  explicit Texts(std::array<char, kHealthText>& into) : next_(into.data()), end_(into.data() + into.size()) {}
  void add(std::string_view text) {
    text = text.substr(0, text.find('\0'));
    if (!fits_ || static_cast<std::size_t>(end_ - next_) <= text.size()) {
      fits_ = false;
      return;
    }
    next_ = std::copy(text.begin(), text.end(), next_);
    *next_++ = '\0';
  }
  bool fits() const { return fits_; }

 private:
  char* next_;
  char* end_;
  bool fits_ = true;
};

}  // namespace

Outbox::Outbox(const RosOptions& options)
    : images(options.queue, options.most_objects), steps(options.queue, options.most_tracks),
      truths(options.queue * std::max<std::size_t>(options.truth_objects, 1)), healths(options.queue),
      most_objects_(options.most_objects), most_tracks_(options.most_tracks), last_truth_(options.truth_objects) {}

bool Outbox::put(const recording::records::ImageWritten& image) {
  WaitingImage* slot = images.room();
  if (slot == nullptr) {
    count(dropped_images_);
    return false;
  }
  slot->valid_at = recording::records::true_time_of(image.stamp, image.valid_at);
  slot->written = image.stamp.true_time;
  slot->newest_measurement.reset();
  if (!image.newest.empty())
    slot->newest_measurement = recording::records::true_time_of(image.stamp, image.newest_measurement);
  slot->sequence = image.sequence;
  const std::size_t objects = std::min(image.objects.size(), most_objects_);
  if (objects < image.objects.size()) count(cut_);
  slot->objects.assign(image.objects.begin(), image.objects.begin() + static_cast<std::ptrdiff_t>(objects));
  images.push();
  return true;
}

void Outbox::begin(std::uint32_t step) {
  step_ = step;
  step_cut_ = false;
  waiting_ = steps.room();
  if (waiting_ != nullptr) waiting_->tracks.clear();
}

bool Outbox::put(const recording::records::TrackState& track) {
  if (track.predicted_for_image) return false;
  if (step_ != track.step) begin(track.step);
  if (waiting_ == nullptr) return false;
  if (waiting_->tracks.size() == most_tracks_) {
    step_cut_ = true;
    return false;
  }
  WaitingTrack& into = waiting_->tracks.emplace_back();
  into.id = track.track;
  into.valid_at = recording::records::true_time_of(track.stamp, track.valid_at);
  std::copy(track.state.begin(), track.state.end(), into.state.begin());
  std::copy(track.covariance.begin(), track.covariance.end(), into.covariance.begin());
  return false;
}

bool Outbox::put(const recording::records::FusionStep& step) {
  if (step_ != step.step) begin(step.step);
  step_.reset();
  if (waiting_ == nullptr) {
    count(dropped_steps_);
    return false;
  }
  if (step_cut_) count(cut_);
  waiting_->at = step.stamp.true_time;
  waiting_->step = step.step;
  waiting_->confirmed = step.confirmed;
  waiting_->tentative = step.tentative;
  steps.push();
  return true;
}

bool Outbox::put(const recording::records::TruthState& truth) {
  if (index_of(truth.object) >= last_truth_.size()) return false;
  std::optional<TrueTime>& last = last_truth_[index_of(truth.object)];
  if (last && truth.at <= *last) return false;
  WaitingTruth* slot = truths.room();
  if (slot == nullptr) {
    count(dropped_truths_);
    return false;
  }
  last = truth.at;
  slot->state = truth;
  truths.push();
  return true;
}

bool Outbox::put(const Health& health) {
  WaitingHealth* slot = healths.room();
  if (slot == nullptr) {
    count(dropped_healths_);
    return false;
  }
  Texts texts(slot->text);
  texts.add(health.name);
  texts.add(health.message);
  for (const HealthValue& value : health.values) {
    texts.add(value.key);
    texts.add(value.value);
  }
  if (!texts.fits()) {
    count(dropped_healths_);
    return false;
  }
  slot->at = health.at;
  slot->level = health.level;
  slot->values = health.values.size();
  healths.push();
  return true;
}

Outbox::Dropped Outbox::dropped() const {
  const auto read = [](const std::atomic<std::uint64_t>& counter) { return counter.load(std::memory_order_relaxed); };
  return {read(dropped_images_), read(dropped_steps_), read(dropped_truths_), read(dropped_healths_), read(cut_)};
}

}  // namespace ttf::bus::dds::ros
