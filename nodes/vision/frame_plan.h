// The frames of a detector that several cameras share: its next camera, and a whole picture or a region of interest
// (schedules/sequence/generator.h). A frame is planned at its beginning, by the times of earlier detections.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "schedules/sequence/generator.h"
#include "schedules/sequence/history.h"

namespace ttf::nodes::vision {

struct FramePlanConfig {
  Duration bound = Duration::milliseconds(200);  // beta
  schedules::sequence::SlotRule slots = schedules::sequence::SlotRule::kText;
  schedules::sequence::SlotOrder order = schedules::sequence::SlotOrder::kText;
  Duration first_guess = Duration::milliseconds(50);  // a primary detection's, before the first one
  std::size_t history = schedules::sequence::DetectionHistory::kKept;
  // A detection occupies the detector for whole steps: no secondary one is expected to be shorter.
  Duration shortest{};
};

class FramePlan {
 public:
  // Allocates all that it needs.
  FramePlan(const FramePlanConfig& config, int cameras);

  // Plans the next frame. `shares` has each camera's region of interest as a share of its picture, 0 for none.
  void begin(std::span<const double> shares);
  // Returns whether all detections of the frame were taken; true before the first frame.
  bool over() const { return place_ == sequence_.size(); }
  // Returns the next detection; the frame is not over.
  const schedules::sequence::Detection& next() const { return sequence_[place_]; }
  void pass() { ++place_; }
  // Takes in the time of a primary detection.
  void add(int camera, Duration took) { history_.add(camera, took); }

  std::uint32_t frame() const { return frames_ - 1; }  // counted from 0
  std::size_t place() const { return place_; }         // the place of next() in the sequence
  const std::string& letters() const { return letters_; }
  Duration bound() const { return config_.bound; }
  Duration length() const { return length_; }  // expected

 private:
  FramePlanConfig config_;
  int cameras_;
  schedules::sequence::DetectionHistory history_;
  schedules::sequence::Sequence sequence_;
  std::vector<int> interest_;
  std::string letters_;
  Duration length_{};
  std::size_t place_ = 0;
  std::uint32_t frames_ = 0;
};

}  // namespace ttf::nodes::vision
