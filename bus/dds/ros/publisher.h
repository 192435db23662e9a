// Publishes real-time images, tracks, healths and truth on DDS as ROS 2 topics, for whoever listens (docs/ros.md).
//
// It is one more sink of records. Whoever records copies into slots made beforehand and goes on: it never waits for
// this, nor for DDS, nor for anybody that listens, and nothing is allocated. A thread of its own writes to DDS. What
// finds all slots taken is dropped and counted. That thread, and DDS' own, begin with the priority and on the
// processors of the thread that makes the publisher: make it before asking for real time.
#pragma once

#include <cstdint>
#include <memory>

#include "bus/dds/ros/health.h"
#include "bus/dds/ros/options.h"
#include "recording/records/records.h"

namespace ttf::bus::dds::ros {

struct TopicCounts {
  std::uint64_t written = 0;           // to DDS
  std::uint64_t dropped = 0;           // there was no room for it here
  std::uint64_t refused = 0;           // DDS did not take it
  std::uint64_t deadlines_missed = 0;  // promised and not kept, as of the last sample written
};

struct RosCounts {
  TopicCounts images, boxes, tracks, truth, health;  // an image that is dropped is counted as such in `images` only
  std::uint64_t cut = 0;                             // images and steps with more in them than RosOptions has room for
};

class RosPublisher final : public recording::records::Sink {
 public:
  // Throws InputError for options out of range, std::runtime_error where DDS does not let us.
  explicit RosPublisher(const RosOptions& options);
  // Writes what still waits, and ends.
  ~RosPublisher() override;
  RosPublisher(const RosPublisher&) = delete;
  RosPublisher& operator=(const RosPublisher&) = delete;

  // From one thread, as every sink.
  using recording::records::Sink::on;
  void on(const recording::records::ImageWritten& image) override;
  void on(const recording::records::TrackState& track) override;
  void on(const recording::records::FusionStep& step) override;
  void on(const recording::records::TruthState& truth) override;
  // From one thread, that or another. Longer than 4096 characters in all, it is dropped.
  void health(const Health& health);

  RosCounts counts() const;  // from any thread; what is written is told a moment later

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace ttf::bus::dds::ros
