// Records with a different value in every field, for tests of their messages.
#pragma once

#include <unistd.h>

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "bus/dds/ros/options.h"
#include "recording/records/records.h"

namespace ttf::bus::dds::ros {

// Differs from the usual default domain.
inline constexpr std::uint32_t kRosDomain = 18;

// A publisher that no other test, of this or another program, is taken for.
inline RosOptions options_of_its_own() {
  static int made = 0;
  RosOptions options;
  options.domain = kRosDomain;
  options.node_name = "test_" + std::to_string(getpid()) + "_" + std::to_string(made++);
  options.origin_realtime_ns = 1'700'000'000'250'000'000;
  return options;
}

// The node's clock of the cluster is 3 ms ahead of true time.
inline recording::records::Stamp stamp_at(std::int64_t true_ns) {
  return {TrueTime{true_ns}, LocalTime{true_ns + 1}, GlobalTime{true_ns + 3'000'000}, NodeId{4}};
}

inline recording::records::ImageObject image_object(int i) {
  const double d = i;
  return {.track = TrackId{static_cast<std::uint16_t>(100 + i)},
          .x = 10 + d,
          .y = 20 + d,
          .heading = 0.1 + d / 100,
          .speed = 30 + d,
          .acceleration = -1 - d,
          .length = 4 + d,
          .width = 2 + d,
          .sigma_x = 0.1 + d,
          .sigma_y = 0.2 + d,
          .correlation_xy = 0.5,
          .sigma_heading = 0.3 + d,
          .sigma_speed = 0.4 + d,
          .sigma_acceleration = 0.6 + d,
          .sigma_length = 0.7 + d,
          .sigma_width = 0.8 + d,
          .status = static_cast<recording::records::ImageStatus>(i % 2 == 0 ? 1 : 6)};
}

// An image written at true_ns, of use 20 ms later, with a newest measurement of 5 ms before. Its record
// refers to it, so it must not move.
struct DrawnImage {
  DrawnImage(std::int64_t true_ns, std::uint32_t sequence, int count) {
    for (int i = 0; i < count; ++i) objects.push_back(image_object(i));
    record.stamp = stamp_at(true_ns);
    record.sequence = sequence;
    record.valid_at = record.stamp.global + Duration::milliseconds(20);
    record.newest_measurement = record.stamp.global - Duration::milliseconds(5);
    record.objects = objects;
    record.newest = newest;
  }
  DrawnImage(const DrawnImage&) = delete;
  DrawnImage& operator=(const DrawnImage&) = delete;
  std::vector<recording::records::ImageObject> objects;
  std::array<MeasurementId, 1> newest{MeasurementId{SensorId{0}, 7}};
  recording::records::ImageWritten record;
};

// A track whose step runs at true_ns, and which is valid 2 ms before.
struct DrawnTrack {
  DrawnTrack(std::int64_t true_ns, std::uint32_t step, int number, bool predicted = false)
      : record{stamp_at(true_ns),
               step,
               TrackId{static_cast<std::uint16_t>(number)},
               stamp_at(true_ns - 2'000'000).global,
               state,
               covariance,
               predicted} {
    for (std::size_t i = 0; i < state.size(); ++i) state[i] = number + static_cast<double>(i) / 10;
    for (std::size_t i = 0; i < covariance.size(); ++i) covariance[i] = number + static_cast<double>(i) / 100;
  }
  DrawnTrack(const DrawnTrack&) = delete;
  DrawnTrack& operator=(const DrawnTrack&) = delete;
  std::array<double, 6> state{};
  std::array<double, 36> covariance{};
  recording::records::TrackState record;
};

inline recording::records::TruthState truth_at(std::int64_t true_ns, std::uint16_t object, std::uint8_t node = 2) {
  return {.at = TrueTime{true_ns},
          .object = ObjectId{object},
          .x = 11.5 + object,
          .y = -3.25,
          .heading = 0.5,
          .speed = 27.5,
          .acceleration = 0.75,
          .yaw_rate = 0.0625,
          .length = 4.5,
          .width = 1.75,
          .local = LocalTime{true_ns},
          .global = GlobalTime{true_ns},
          .node = NodeId{node}};
}

}  // namespace ttf::bus::dds::ros
