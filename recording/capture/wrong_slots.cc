#include "recording/capture/wrong_slots.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "recording/capture/cycles.h"

namespace ttf::recording::capture {
namespace {

constexpr std::size_t kFrameIds = 2048;  // 11 bits
constexpr std::int64_t kCyclesAway = 2, kCyclesBetween = 8;
constexpr std::int64_t kAgreement = 10;  // fractions of a slot

// Returns the median; `values` are not empty, and are reordered.
template <class Number> Number median(std::vector<Number>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

class SlotJudge {
 public:
  SlotJudge(const schedules::model::GlobalParameters& flexray, std::span<const StampedFrame> frames)
      : flexray_(flexray), frames_(frames) {
    const std::int64_t nominal = flexray.cycle_ps() / 1000;
    stretch_ = stretch(nominal);
    cycle_ = std::llround(stretch_ * static_cast<double>(nominal));
    slot_ = std::llround(stretch_ * static_cast<double>(slot_length_ns(flexray)));
  }

  std::optional<int> elsewhere(std::size_t index) {
    if (is_impossible(index)) return std::nullopt;
    const std::optional<std::int64_t> start = cycle_start(index);
    if (!start) return std::nullopt;
    const StampedFrame& frame = frames_[index];
    // A slot reaches half a slot to either side of a frame's place in it; slot 1 thus begins before its cycle.
    const auto since = static_cast<double>(modulo(frame.time_ns - *start + slot_ / 2));
    const int slot = static_cast<int>(since / (stretch_ * static_cast<double>(slot_length_ns(flexray_)))) + 1;
    if (slot <= flexray_.gNumberOfStaticSlots) return slot != frame.slot ? std::optional(slot) : std::nullopt;
    return is_static(frame) ? std::optional(flexray_.gNumberOfStaticSlots + 1) : std::nullopt;
  }

 private:
  bool is_static(const StampedFrame& frame) const {
    return frame.slot >= 1 && frame.slot <= flexray_.gNumberOfStaticSlots;
  }

  // Returns how much longer a cycle is by the capture's clock: the median over consecutive frames of one slot
  // and channel.
  double stretch(std::int64_t nominal) const {
    std::vector<const StampedFrame*> before(kFrameIds * 2);
    std::vector<double> all;
    for (const StampedFrame& frame : frames_) {
      if (!is_static(frame)) continue;
      const StampedFrame*& last = before[static_cast<std::size_t>(frame.slot) * 2 + index_of(frame.channel)];
      if (last != nullptr) {
        const double passed = static_cast<double>(frame.time_ns - last->time_ns) / static_cast<double>(nominal);
        const double cycles = std::round(passed);
        if (cycles >= 1 && cycles <= kCyclesBetween) all.push_back(passed / cycles);
      }
      last = &frame;
    }
    if (all.empty()) return 1.0;
    const double usual = median(all);
    return std::abs(usual - 1.0) <= kClockDeviation ? usual : 1.0;
  }

  std::int64_t modulo(std::int64_t time) const { return (time % cycle_ + cycle_) % cycle_; }
  // Wraps into the half cycles before and after 0.
  std::int64_t wrapped(std::int64_t time) const { return modulo(time + cycle_ / 2) - cycle_ / 2; }
  // Returns when the cycle of a static frame began, or a cycle a whole number of cycles away.
  std::int64_t phase(const StampedFrame& frame) const {
    return frame.time_ns - std::llround(stretch_ * static_cast<double>(static_slot_offset_ns(flexray_, frame.slot)));
  }

  // S2. Frames are in order: only those right before and after can be so near.
  bool is_impossible(std::size_t index) const {
    const StampedFrame& frame = frames_[index];
    const auto is_there = [&](const StampedFrame& other) { return other.channel == frame.channel; };
    for (std::size_t i = index; i-- > 0 && frame.time_ns - frames_[i].time_ns <= slot_ / 2;)
      if (is_there(frames_[i])) return true;
    for (std::size_t i = index + 1; i < frames_.size() && frames_[i].time_ns - frame.time_ns <= slot_ / 2; ++i)
      if (is_there(frames_[i])) return true;
    return false;
  }

  // Returns when a cycle began by the neighbours' stamps (S3).
  std::optional<std::int64_t> cycle_start(std::size_t index) {
    const StampedFrame& frame = frames_[index];
    const std::int64_t reach = kCyclesAway * cycle_;
    witnesses_.clear();
    const auto add = [&](const StampedFrame& other) {
      if (is_static(other) && other.slot != frame.slot) witnesses_.push_back(&other);
    };
    for (std::size_t i = index;
         i-- > 0 && witnesses_.size() < kWitnesses && frame.time_ns - frames_[i].time_ns <= reach;)
      add(frames_[i]);
    const std::size_t before = witnesses_.size();
    for (std::size_t i = index + 1;
         i < frames_.size() && witnesses_.size() < before + kWitnesses && frames_[i].time_ns - frame.time_ns <= reach;
         ++i)
      add(frames_[i]);
    if (witnesses_.size() < kLeastWitnesses) return std::nullopt;

    const std::int64_t first = phase(*witnesses_.front());
    phases_.clear();
    for (const StampedFrame* witness : witnesses_) phases_.push_back(wrapped(phase(*witness) - first));
    const std::int64_t start = first + median(phases_);
    std::size_t agree = 0;
    int slot = 0;
    bool several = false;
    for (const StampedFrame* witness : witnesses_) {
      if (std::abs(wrapped(phase(*witness) - start)) > slot_ / kAgreement) continue;
      ++agree;
      several = several || (slot != 0 && witness->slot != slot);
      slot = witness->slot;
    }
    if (!several || 4 * agree < 3 * witnesses_.size()) return std::nullopt;
    return start;
  }

  const schedules::model::GlobalParameters& flexray_;
  std::span<const StampedFrame> frames_;
  double stretch_ = 1.0;
  std::int64_t cycle_ = 0, slot_ = 0;           // by the capture's clock [ns]
  std::vector<const StampedFrame*> witnesses_;  // members, to keep their memory
  std::vector<std::int64_t> phases_;
};

}  // namespace

std::vector<std::optional<int>> frames_in_wrong_slots(const schedules::model::GlobalParameters& flexray,
                                                      std::span<const StampedFrame> frames) {
  SlotJudge judge(flexray, frames);
  std::vector<std::optional<int>> found;
  found.reserve(frames.size());
  for (std::size_t i = 0; i < frames.size(); ++i) found.push_back(judge.elsewhere(i));
  return found;
}

}  // namespace ttf::recording::capture
