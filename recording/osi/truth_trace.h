// The world of another simulator: moving objects over ground, from an ASAM OSI trace of GroundTruth or of SensorView's
// global_ground_truth.
//
// Instants are those of the messages. Stamps must ascend; nanoseconds may exceed a second, as some tools write them. An
// object is there in the messages that have it, and may go and come again. It keeps its size. The host vehicle, if the
// trace names one, carries the sensors: it is in every message, and no object.
//
// An absent velocity is the positions' difference. Absent acceleration and yaw rate are differences, too.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/time.h"

namespace ttf::recording::osi {

// The state of the middle of the bounding box; vectors are along the ground's axes.
struct TracedState {
  double x = 0.0, y = 0.0, heading = 0.0;  // [m], [rad] from x to y
  double vx = 0.0, vy = 0.0;               // [m/s]
  double ax = 0.0, ay = 0.0;               // [m/s^2]
  double yaw_rate = 0.0;                   // [rad/s]
};

enum class TracedKind : std::uint8_t { kVehicle, kTwoWheeler, kPedestrian, kOther };
std::string_view name_of(TracedKind kind);  // "two-wheeler"

struct TracedObject {
  // In successive messages, from that of TruthTrace::instants[first] on.
  struct Life {
    std::size_t first = 0;
    std::vector<TracedState> states;
  };
  std::uint64_t id = 0;  // the trace's
  TracedKind kind = TracedKind::kOther;
  double length = 0.0, width = 0.0;  // [m]
  std::vector<Life> lives;           // in the order of time, with messages between
};

struct TracedHost {
  TracedObject vehicle;               // with one life, in all messages
  double rear_x = 0.0, rear_y = 0.0;  // from the middle of its box to that of the rear axle, in its axes [m]
  bool has_rear = false;              // else unknown, and zero
};

inline constexpr std::size_t kMostTracedObjects = 65'534;  // whose ids are no false detection's

// A trace has at least one message and one object, and an object at least one state.
struct TruthTrace {
  std::string hash;                   // content hash of the file
  std::string name;                   // the file's, for messages
  std::string type;                   // "GroundTruth" or "SensorView"
  bool guessed = false;               // the type was found from the messages: the file does not name it
  std::vector<Duration> instants;     // since the first
  std::vector<TracedObject> objects;  // in the order of their coming, then of their ids
  std::optional<TracedHost> host;

  Duration length() const { return instants.back(); }
};

// Reads `.osi` (each message behind its length) and OSI's MCAP. Throws InputError with one sentence, also for a file
// that was cut off. `name` stands for the file.
TruthTrace parse_truth_trace(std::string_view bytes, const std::string& name);

}  // namespace ttf::recording::osi
