// The rules for a schedule in real time. Its nodes are processes that an ordinary kernel wakes up late, on media
// that carry frames as they come. In virtual time these rules do not matter.
//
// The time scale says how many times longer the drive lasts in real time than by the schedule: real time = time
// scale x drive time. It is in parts per million, so that it is exact. Arrival windows (cluster.h) are in real
// time at any scale.
//
// The rules and their reasons:
//   W1  there is an arrival window
//   W2  late <= room: from the action point of the last static slot in use to the end of the static segment, stretched.
//       Every frame within its arrival window has then arrived before the static segment ends; after that the clocks
//       are corrected.
//   W3  early + late < one cycle, stretched: the arrival windows of one slot in two successive cycles do not overlap.
//       Within a cycle they may, as frames are identified by their slot. Those of a cycle's first slots may begin in
//       the cycle before.
//   W4  the dynamic segment is unused: minislots of some microseconds pass unseen between two wake-ups
//   W5  no star, no guardian: both are simulated and exist in virtual time only
//   W6  no message of a CAN has an identifier of a sensor's lines there (sensor_lines.h): in virtual time triggers and
//       strobes are wires of their own
//   W7  every sensor's device writes to a CAN, which carries its lines
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/errors.h"
#include "core/time.h"
#include "schedules/model/cluster.h"

namespace ttf::schedules::check {

inline constexpr std::int64_t kTimeScaleOne = 1'000'000;                // ppm: as scheduled
inline constexpr std::int64_t kSmallestTimeScale = kTimeScaleOne / 10;  // limits of --time-scale
inline constexpr std::int64_t kLargestTimeScale = 1'000 * kTimeScaleOne;

// Returns the time scale in the form of --time-scale: "1.5".
std::string time_scale_text(std::int64_t time_scale_ppm);

// Returns a duration of the schedule in real time, rounded down.
Duration stretched(Duration scheduled, std::int64_t time_scale_ppm);

// Returns the last static slot in use; 0 if all are silent.
int last_static_slot(const model::Cluster& cluster);

// W2: returns the room at this time scale, rounded down to nanoseconds. In a silent static segment it begins at
// the action point of slot 1.
Duration arrival_room(const model::Cluster& cluster, std::int64_t time_scale_ppm);

// Returns the smallest time scale at which W2 and W3 hold for this arrival window; it may exceed
// kLargestTimeScale.
std::int64_t smallest_time_scale(const model::Cluster& cluster, const model::ArrivalWindow& window);

// Returns all violations of the rules at this time scale, rule by rule; empty for a cluster that can run in real
// time. The cluster must have passed check().
std::vector<Finding> check_real_time(const model::Cluster& cluster, std::int64_t time_scale_ppm);

}  // namespace ttf::schedules::check
