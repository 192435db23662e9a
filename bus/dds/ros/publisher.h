// A ROS publisher publishes real-time images, tracks, healths and truth on DDS as ROS 2 topics (docs/media/dds.md).
//
// It is one more sink of records. The recording thread copies records into slots allocated at construction. It
// never allocates, and never waits for the publisher, for DDS or for a listener. Records without a free slot
// are dropped and counted. A thread of the publisher's own writes to DDS. It and those of DDS inherit priority
// and processors from the thread that makes the publisher: make it before asking for real time.
#pragma once

#include <cstdint>
#include <memory>

#include "bus/dds/ros/health.h"
#include "bus/dds/ros/options.h"
#include "recording/records/records.h"

namespace ttf::bus::dds::ros {

struct TopicCounts {
  std::uint64_t written = 0;           // to DDS
  std::uint64_t dropped = 0;           // for want of room here
  std::uint64_t refused = 0;           // by DDS
  std::uint64_t deadlines_missed = 0;  // as of the last sample written
};

struct RosCounts {
  TopicCounts images, boxes, tracks, truth, health;  // a dropped image counts as such in `images` only
  std::uint64_t cut = 0;                             // images and steps with more objects or tracks than RosOptions
                                                     // allows
};

class RosPublisher final : public recording::records::Sink {
 public:
  // Throws InputError for options out of range, std::runtime_error if DDS refuses.
  explicit RosPublisher(const RosOptions& options);
  // Writes the waiting items, and ends.
  ~RosPublisher() override;
  RosPublisher(const RosPublisher&) = delete;
  RosPublisher& operator=(const RosPublisher&) = delete;

  // For one thread, as in every sink.
  using recording::records::Sink::on;
  void on(const recording::records::ImageWritten& image) override;
  void on(const recording::records::TrackState& track) override;
  void on(const recording::records::FusionStep& step) override;
  void on(const recording::records::TruthState& truth) override;
  // For one thread, the same or another. A health with more than 4096 characters in all is dropped.
  void health(const Health& health);

  RosCounts counts() const;  // from any thread; written samples count a moment later

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace ttf::bus::dds::ros
