// The expected error of tracks that a sequence of detections feeds, by a covariance recursion without draws.
//
// Each sensor sees an object of its own. Along one axis the object moves at a constant velocity with white acceleration
// of density q, and a filter with the same model follows it. The position is measured at the beginning of each of the
// sensor's detections, primary or secondary, with the standard deviation sigma. The result is there at the detection's
// end. Between results the state is predicted: behind the measurement at m_k, with the covariance P after its update,
// the position's variance is
//   P11 + 2 P12 d + P22 d^2 + q d^3 / 3,   d = t - m_k,
// for t from the end of detection k to that of the sensor's next one.
// The frame is repeated for ever, and the recursion runs until a frame no longer changes P. Every detection finds the
// object. Reference: Bar-Shalom, Li, Kirubarajan, "Estimation with Applications to Tracking and Navigation" (2001),
// 6.2.2.
#pragma once

#include <vector>

#include "schedules/sequence/detections.h"
#include "schedules/sequence/generator.h"

namespace ttf::schedules::sequence {

struct TrackingModel {
  double process_noise = 1.0;  // [m^2/s^3], above 0
  double sigma = 1.0;          // [m], above 0
};

// The position's variance along one axis [m^2].
struct ExpectedError {
  double mean = 0.0;   // over time
  double worst = 0.0;  // at the worst instant, just before a result
};
// Returns them by sensor. Each sensor has a detection.
std::vector<ExpectedError> expected_errors(const Sequence& sequence, const DetectionTimes& times,
                                           const TrackingModel& model);

// A number of secondary detections, and the error with it.
struct BoundChoice {
  int secondaries = 0;
  Duration least_bound{};  // the least bound that gives this frame, or one nanosecond less where it must be exceeded
  Sequence sequence;
  double interest = 0.0;  // mean variance of the objects of interest [m^2]
  double others = 0.0;    // likewise; 0 without others
  double cost = 0.0;      // share * interest + (1 - share) * others
};
// Returns a choice for each number of secondary detections that a bound up to that of `request` gives, all of them at
// most kMostSecondaries. `share` of 0..1 is that of the objects of interest; without others it counts as 1. The request
// has a sensor of interest and the time of a secondary detection.
std::vector<BoundChoice> choices(const FrameRequest& request, const DetectionTimes& times, const TrackingModel& model,
                                 double share);
// Returns the first of the choices with the least cost.
const BoundChoice& best(const std::vector<BoundChoice>& choices);

}  // namespace ttf::schedules::sequence
