// The options of a RosPublisher: its samples, their names, and the quality of service for listeners.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>

#include "core/time.h"

namespace ttf::bus::dds::ros {

struct RosOptions {
  std::uint32_t domain = 0;                 // DDS' domain, ROS_DOMAIN_ID: 0..231
  std::string node_name = "ttfusion";       // topics are /<node_name>/...; up to 64 letters, digits and single '_'
  std::int64_t origin_realtime_ns = 0;      // CLOCK_REALTIME at true time 0 of the drive: stamps are on ROS' clock
  std::int64_t time_scale_ppm = 1'000'000;  // real time per time of the drive, 100'000..1'000'000'000
  std::string frame_id = "sensor_car";      // the frame of all messages: x forward, y left (ISO 8855, as REP 103)

  // The deadline of a new sample is `deadline_slack` times the period, in real time. Zero: no deadline.
  Duration image_period{};  // for images, and for the boxes made of them
  Duration step_period{};   // for tracks: one sample for each step of the fusion
  Duration truth_period{};  // for each object
  Duration health_period{};
  double deadline_slack = 1.5;                       // at least 1
  std::chrono::milliseconds liveliness_lease{1000};  // a publisher silent for so long counts as dead; 100 ms to 1 h

  // Others publish the topics that this one does not, so that each has one publisher. All publish their health.
  bool images = true, tracks = true;
  std::uint16_t truth_objects = 0;  // publishes the truth of this many objects, the first
  std::size_t most_objects = 64;    // in an image, 1..1024; further ones are cut off and counted
  std::size_t most_tracks = 64;     // in a step, likewise
  std::size_t queue = 16;           // images, steps, instants of truth and healths that wait; 1..1024 each
};

// Returns the lease of the publisher's participant. Its announcements go that often, so a process that was
// stopped is found again after a few leases.
inline std::chrono::milliseconds lease_of(const RosOptions& options) { return 3 * options.liveliness_lease; }

// Throws InputError with one finding for each value out of range.
void validate(const RosOptions& options);

// Returns the domain of ROS_DOMAIN_ID, as ROS' own nodes use it; 0 if it is unset or empty. Throws InputError
// unless it is a whole number 0..231.
std::uint32_t domain_of_environment();

// Joins the options' domain as a RosPublisher does, and leaves it. Throws std::runtime_error if DDS refuses.
void try_domain(const RosOptions& options);

}  // namespace ttf::bus::dds::ros
