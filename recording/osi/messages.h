// The messages of a trace file, and their type. Private to the room.
//
// `.osi` does not name the type of its messages, and the files' names need not. So the type is the one in which a message makes
// sense: a GroundTruth has a stamp and a moving object with id and position, a SensorView has such a GroundTruth inside, and a
// SensorData has a detected object with a tracking id. Their fields differ in number and wire type, so that at most one fits.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/errors.h"

namespace ttf::recording::osi {

enum class MessageType { kGroundTruth, kSensorView };

struct TraceMessages {
  MessageType type = MessageType::kGroundTruth;
  bool guessed = false;
  std::vector<std::string_view> messages;  // within the file's bytes, or within `kept`
  std::vector<std::string> kept;           // of compressed chunks

  TraceMessages() = default;
  TraceMessages(TraceMessages&&) = default;  // moving keeps the views into `kept` valid
  TraceMessages& operator=(TraceMessages&&) = default;
  TraceMessages(const TraceMessages&) = delete;
  TraceMessages& operator=(const TraceMessages&) = delete;
};

// Throws InputError with one finding: no message, another type, a message cut off, damage.
TraceMessages trace_messages(std::string_view bytes, const std::string& name);

}  // namespace ttf::recording::osi
