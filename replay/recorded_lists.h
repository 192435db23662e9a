// Recorded observations as a fusion node receives them: lists, each of one sensor and one instant, in the order in
// which they arrive.
//
// A list is all rows of a sensor at a time that arrive at one instant; the same sensor and time with another arrival is
// the list heard again. Lists are numbered by sensor in the order of their measurements, so that their numbers say
// nothing of when they arrived. Of several measurements at one instant the tracker takes that of the first sensor
// first, as the configuration lists them, whatever the order of rows.
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
#include "recording/rows/observation_rows.h"
#include "replay/config.h"

namespace ttf::replay {

struct RecordedList {
  MeasurementId id;
  GlobalTime measured{}, arrival{};
  std::uint32_t copy = 0;  // how often it was heard before
  std::vector<fusion::sensors::Observation> observations;

  fusion::sensors::ObservationList view() const { return {id, measured, observations}; }
};

struct RecordedLists {
  std::vector<std::string> sensors;  // by SensorId
  std::vector<std::string> classes;  // by fusion::ClassId, in the order of their names
  std::vector<RecordedList> lists;   // in the order of arrival; at one instant, in that of measurement
};

// Where the configuration lists no sensor: lists those of the rows, by name, each as `any`. Throws InputError, naming
// the file, where they are more than kMostSensors.
void list_sensors(ReplayConfig& config, const std::vector<recording::rows::ObservationRow>& rows,
                  const SensorSetup& any, const std::string& name);

// One finding, and the row left out, for each row of a sensor that the configuration does not list, with a covariance
// that is none, or beyond the most observations that a list may have (max_observations of the tracker). `name`: the
// file's. Throws InputError where there are more classes than fusion::kMostClasses.
RecordedLists recorded_lists_of(const std::vector<recording::rows::ObservationRow>& rows, const ReplayConfig& config,
                                const std::string& name, Findings& findings);

// Delays that are drawn in place of the recorded ones, and arrivals in disorder. Draws depend on the seed, the sensor's
// place among the sensors, the number of the list and which copy of it it is, never on what else there is.
struct SimulatedArrivals {
  struct Delay {
    Duration least, most;  // drawn evenly, both ends included
  };
  std::vector<std::optional<Delay>> delays;  // by sensor; of those without one the recorded delays stay
  // Each so many lists that arrive one after the other come together when the last of them arrives, in drawn order; 1:
  // as they come.
  std::size_t shuffle = 1;
  std::uint64_t seed = 1;
};
void simulate(RecordedLists& recorded, const SimulatedArrivals& simulated);

}  // namespace ttf::replay
