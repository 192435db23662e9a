// Traces for tests, by Protocol Buffers' own library.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "recording/mcap/bytes.h"
#include "recording/mcap/writer.h"
#include "recording/osi/osi.pb.h"

namespace ttf::recording::osi {

inline osi3::MovingObject& add_object(osi3::GroundTruth& truth, std::uint64_t id, double x, double y,
                                      double yaw = 0.0) {
  osi3::MovingObject& object = *truth.add_moving_object();
  object.mutable_id()->set_value(id);
  osi3::BaseMoving& base = *object.mutable_base();
  base.mutable_dimension()->set_length(5.0);
  base.mutable_dimension()->set_width(2.0);
  base.mutable_position()->set_x(x);
  base.mutable_position()->set_y(y);
  base.mutable_orientation()->set_yaw(yaw);
  return object;
}

inline osi3::GroundTruth truth_at(std::int64_t seconds, std::uint32_t nanos) {
  osi3::GroundTruth truth;
  truth.mutable_timestamp()->set_seconds(seconds);
  truth.mutable_timestamp()->set_nanos(nanos);
  return truth;
}

// An object, 42, that goes along x from 0 m by 0.5 m a message of 10 ms.
inline std::vector<osi3::GroundTruth> steady(int messages) {
  std::vector<osi3::GroundTruth> truths;
  for (int k = 0; k < messages; ++k) {
    truths.push_back(truth_at(k / 100, static_cast<std::uint32_t>(k % 100) * 10'000'000u));
    add_object(truths.back(), 42, 0.5 * k, 1.0);
  }
  return truths;
}

template <class Message> std::string framed(const std::vector<Message>& messages) {
  std::string bytes;
  for (const Message& message : messages) {
    const std::string one = message.SerializeAsString();
    mcap::put(bytes, static_cast<std::uint32_t>(one.size()));
    bytes += one;
  }
  return bytes;
}

}  // namespace ttf::recording::osi
