// The messages of a trace file, and their type. Private to the module.
//
// `.osi` does not name the type of its messages, and neither may the file's name. So the type is that in which a
// message makes sense. A GroundTruth has a stamp and a moving object with id and position. A SensorView has such a
// GroundTruth inside. A SensorData has a detected object with a tracking id. These fields differ in number and wire
// type, so at most one type fits.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/errors.h"

namespace ttf::recording::osi {

inline constexpr std::int64_t kNsPerSecond = 1'000'000'000;

enum class MessageType { kGroundTruth, kSensorView };

struct TraceMessages {
  MessageType type = MessageType::kGroundTruth;
  bool guessed = false;
  std::vector<std::string_view> messages;  // within the file's bytes, or within `kept`
  std::vector<std::string> kept;           // copies out of compressed chunks

  TraceMessages() = default;
  TraceMessages(TraceMessages&&) = default;  // moving keeps the views into `kept` valid
  TraceMessages& operator=(TraceMessages&&) = default;
  TraceMessages(const TraceMessages&) = delete;
  TraceMessages& operator=(const TraceMessages&) = delete;
};

// Throws InputError with one finding: no message, another type, a message cut off, damage.
TraceMessages trace_messages(std::string_view bytes, const std::string& name);

}  // namespace ttf::recording::osi
