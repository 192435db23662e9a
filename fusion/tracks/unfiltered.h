// The part of a track that no filter estimates: the class of its object and the third axis.
//
// It is a value within the track, so it rewinds with the track when a late list rewrites the past. Sums and
// newest values follow the order of measurement to the last bit, whatever the order of arrival.
#pragma once

#include <array>
#include <cstddef>

#include "fusion/sensors/observation.h"

namespace ttf::fusion::tracks {

// Scores summed by class.
struct Classification {
  std::array<double, sensors::kMostClasses> sums{};

  void add(sensors::ClassId what, double score) { sums[static_cast<std::size_t>(what)] += score; }
  // Returns the class of the largest sum, of equal ones the first; kNoClass if no sum is above zero.
  sensors::ClassId best() const {
    std::size_t best = 0;
    for (std::size_t i = 1; i < sums.size(); ++i)
      if (sums[i] > sums[best]) best = i;
    return sums[best] > 0.0 ? static_cast<sensors::ClassId>(best) : sensors::kNoClass;
  }
  // Returns the best class's part of all scores; 0 without scores.
  double share() const {
    double all = 0.0, most = 0.0;
    for (const double sum : sums) {
      all += sum;
      most = sum > most ? sum : most;
    }
    return all > 0.0 ? most / all : 0.0;
  }
};

struct Unfiltered {
  Classification classes;
  sensors::ThirdAxis third;  // each from the newest observation that had it
};

inline void carry(Unfiltered& unfiltered, const sensors::Observation& observation) {
  if (observation.class_id != sensors::kNoClass) unfiltered.classes.add(observation.class_id, observation.score);
  const sensors::ThirdAxis& seen = observation.third;
  if (seen.has_z) {
    unfiltered.third.has_z = true;
    unfiltered.third.z = seen.z;
  }
  if (seen.has_height) {
    unfiltered.third.has_height = true;
    unfiltered.third.height = seen.height;
  }
}

}  // namespace ttf::fusion::tracks
