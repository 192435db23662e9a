// Whether a schedule can be kept in real time: by processes of their own, which an ordinary kernel wakes up late, on
// media that carry frames when they get them. In virtual time none of this matters.
//
// The time scale says how much longer the drive lasts in real time than by the schedule: real time = time scale x drive
// time, in parts per million, so that it is exact. Arrival windows (cluster.h) are in real time at any scale.
//
// The rules, and why:
//   W1  there is an arrival window
//   W2  late <= room: from the action point of the last static slot in use to the end of the static segment, stretched.
//       So every frame that comes in its window has come before the static segment ends, after which the clocks are
//       corrected.
//   W3  early + late < one cycle, stretched: no instant lies in the windows of one slot in two successive cycles.
//       Within a cycle windows may overlap, as frames are known by their slot; and those of a cycle's first slots may
//       begin in the cycle before.
//   W4  nothing is sent in the dynamic segment: minislots of some microseconds pass unseen between two wake-ups
//   W5  no star, no guardian: they are simulated, and so are there in virtual time only
//   W6  no message of a CAN has an identifier that a sensor's lines have there (sensor_lines.h): in virtual time
//       triggers and strobes are wires of their own
//   W7  every sensor's device writes to a CAN, where its lines can be
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/errors.h"
#include "core/time.h"
#include "schedules/model/cluster.h"

namespace ttf::schedules::check {

inline constexpr std::int64_t kTimeScaleOne = 1'000'000;                // ppm: as the schedule says
inline constexpr std::int64_t kSmallestTimeScale = kTimeScaleOne / 10;  // what --time-scale takes
inline constexpr std::int64_t kLargestTimeScale = 1'000 * kTimeScaleOne;

// As --time-scale takes it: "1.5".
std::string time_scale_text(std::int64_t time_scale_ppm);

// A duration of the schedule in real time, rounded down.
Duration stretched(Duration scheduled, std::int64_t time_scale_ppm);

// The last static slot that anybody sends in, 0 if there is none.
int last_static_slot(const model::Cluster& cluster);

// W2: the room at this time scale, rounded down to nanoseconds; all of the static segment behind slot 1's
// action point where nobody sends.
Duration arrival_room(const model::Cluster& cluster, std::int64_t time_scale_ppm);

// The smallest time scale at which W2 and W3 hold for this window; it may be beyond kLargestTimeScale.
std::int64_t smallest_time_scale(const model::Cluster& cluster, const model::ArrivalWindow& window);

// What is in the way of running this cluster in real time at this time scale, rule by rule; empty where
// nothing is. The cluster must have passed check().
std::vector<Finding> check_real_time(const model::Cluster& cluster, std::int64_t time_scale_ppm);

}  // namespace ttf::schedules::check
