// Recorded observations as a fusion node receives them: lists of one sensor and one instant each, in the order
// of arrival.
//
// A list is all rows of a sensor at a time that arrive at one instant. Rows of the same sensor and time with
// another arrival are a copy of the list. Lists are numbered by sensor in the order of their measurements,
// independent of their arrival. The tracker takes in measurements of one instant in the configuration's order of
// sensors, whatever the order of rows.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/errors.h"
#include "core/ids.h"
#include "core/time.h"
#include "fusion/sensors/observation.h"
#include "recording/replay/config.h"
#include "recording/rows/observation_rows.h"

namespace ttf::recording::replay {

struct RecordedList {
  MeasurementId id;
  GlobalTime measured{}, arrival{};
  std::uint32_t copy = 0;  // the number of earlier copies
  std::vector<fusion::sensors::Observation> observations;
  std::optional<fusion::sensors::Mounting> vehicle{};  // its place, if it moves (recording/replay/recorded_ego.h)

  fusion::sensors::ObservationList view() const { return {id, measured, observations, vehicle}; }
};

struct RecordedLists {
  std::vector<std::string> sensors;  // by SensorId
  std::vector<std::string> classes;  // by fusion::ClassId, in alphabetical order
  std::vector<RecordedList> lists;   // in the order of arrival; at one instant, of measurement
};

// For a configuration without sensors: adds those of the rows, by name, each as `any`. Throws InputError, which
// names the file, if they exceed kMostSensors.
void list_sensors(ReplayConfig& config, const std::vector<recording::rows::ObservationRow>& rows,
                  const SensorSetup& any, const std::string& name);

// Puts rows into lists. A row is a finding and left out if the configuration lacks its sensor, if its covariance
// is invalid, or if its list is full (max_observations of the tracker). `name` is the file's. Throws InputError
// if there are more classes than fusion::kMostClasses.
RecordedLists recorded_lists_of(const std::vector<recording::rows::ObservationRow>& rows, const ReplayConfig& config,
                                const std::string& name, Findings& findings);

// Drawn delays instead of the recorded ones, and shuffled arrivals. Draws depend only on the seed, the sensor's
// index, the number of the list and its copy.
struct SimulatedArrivals {
  struct Delay {
    Duration least, most;  // drawn evenly, both ends included
  };
  std::vector<std::optional<Delay>> delays;  // by sensor; absent: the recorded delays stay
  // Each group of this many successive lists arrives together, when its last list arrives, in drawn order; 1: no
  // shuffling.
  std::size_t shuffle = 1;
  std::uint64_t seed = 1;
};
void simulate(RecordedLists& recorded, const SimulatedArrivals& simulated);

}  // namespace ttf::recording::replay
