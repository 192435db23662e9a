// The topics and their writers to DDS: names, types and qualities as ROS 2 expects them (docs/media/dds.md has the table).
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bus/dds/common/participant.h"
#include "bus/dds/ros/messages.h"
#include "bus/dds/ros/options.h"
#include "bus/dds/ros/outbox.h"

namespace ttf::bus::dds::ros {

// One topic and its writer.
class Writer {
 public:
  struct Counts {
    std::uint64_t written = 0;
    std::uint64_t refused = 0;           // by DDS, because its memory is full or for another reason
    std::uint64_t deadlines_missed = 0;  // a sample came later than its deadline, or never
  };
  Writer(const common::Participant& participant, const void* type, const std::string& topic, Duration period,
         bool kept_for_late_listeners, const RosOptions& options);
  void write(const void* sample);  // never waits
  Counts counts() const;

 private:
  common::Handle writer_ = 0;
  Counts counts_;
};

class Writers {
 public:
  // Throws std::runtime_error if DDS refuses.
  explicit Writers(const RosOptions& options);

  void write(const WaitingImage& image);
  void write(const WaitingStep& step);
  void write(const WaitingTruth& truth);
  void write(const WaitingHealth& health);

  // Without a writer, nothing is counted.
  Writer::Counts images() const { return images_ ? images_->counts() : Writer::Counts{}; }
  Writer::Counts boxes() const { return boxes_ ? boxes_->counts() : Writer::Counts{}; }
  Writer::Counts tracks() const { return tracks_ ? tracks_->counts() : Writer::Counts{}; }
  Writer::Counts truths() const;  // for all objects
  Writer::Counts healths() const { return healths_.counts(); }

 private:
  common::Participant participant_;
  Messages messages_;
  std::optional<Writer> images_, boxes_, tracks_;
  Writer healths_;
  std::vector<Writer> truths_;  // by object
};

}  // namespace ttf::bus::dds::ros
