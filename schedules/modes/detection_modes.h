// Sequences of detections as time-triggered schedules: the modes of a detector's task.
//
// In a cluster, one task stands for the detector that several cameras share. A mode is a frame of schedules/sequence
// with an instant for each detection: they begin on a grid of whole cycles, and each occupies the task for whole steps
// of the grid, at least two. Its list is written its worst-case duration behind its beginning, by the node's clock,
// even if the detection ends before. With Grid::best_case, the list is written when the detection ends, at least so
// long behind its beginning. Modes change at a frame's end only. A frame may begin at any step of the grid, because
// frames before it have different lengths.
//
// A mode is sound if
//   steps     a step is a whole number of cycles, as the slots of the lists repeat with cycles
//   ends      each detection ends before its steps do, by any clock
//   lists     each list is in its slots, or given to its CAN, before the next one is written: none is torn or
//             replaced. Two detections in a row may be of the same camera, in any modes. In the dynamic segment its
//             turn comes in every cycle of its frames, and its latest turn counts. This holds for all modes at once,
//             and so where they change.
// For a sound mode, the chain from a picture to the actuator is bounded over every cycle in which its detection may
// begin (schedules/analysis/chain).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/errors.h"
#include "core/ids.h"
#include "core/time.h"
#include "schedules/model/cluster.h"
#include "schedules/sequence/detections.h"

namespace ttf::schedules::modes {

struct Grid {
  // Detections begin every so often, in cycles of which one is `base_cycle`.
  Duration step = Duration::milliseconds(10);
  Macroticks offset{0};  // a detection begins there in its cycle
  // The shortest detection, if a list is written as soon as its detection ends.
  std::optional<Duration> best_case = std::nullopt;
  int base_cycle = 0;
};
// Returns the instants within a round at which a detection may begin: those of the grid.
std::vector<GlobalTime> beginnings(const model::Cluster& cluster, const Grid& grid);
// Returns the longest time that a detection takes in global time.
Duration by_any_clock(const model::Cluster& cluster, Duration worst_case);

struct PlacedDetection {
  sequence::Detection detection;
  std::int64_t cycle = 0;  // its number in the frame, from 0
  Duration begins{};       // from the frame's beginning
  Duration worst_case{};
  Duration best_case{};  // the worst case, if lists wait for it
  Duration occupied{};
  int line = 0;  // in the cluster's file, if it states the mode
};

struct Mode {
  std::string name;  // for people; letters are those of the cameras' places
  Duration bound{};  // beta, for people
  sequence::Sequence sequence;
  std::int64_t cycles = 0;  // of a frame
  Duration frame{};
  std::vector<PlacedDetection> detections;
};

// Returns the mode of a sequence. `times` are the detections' worst cases. The step is a whole number of cycles.
Mode placed(const model::Cluster& cluster, const sequence::Sequence& sequence, const sequence::DetectionTimes& times,
            const Grid& grid);

// The detector's task.
struct Detector {
  NodeId node{};
  const model::Task* task = nullptr;
  bool stated = false;  // its modes are those of the cluster's file (schedules/modes/stated.h), and not options'
};

// Returns what is wrong with the modes in this cluster, each in one sentence: about a key of its file, or about an option
// of `schedule sequence`. The cluster must have passed all other rules of check().
std::vector<Finding> unsound(const model::Cluster& cluster, const Detector& detector, const std::vector<Mode>& modes,
                             const Grid& grid);

// Bounds for one camera of one mode, in a chain behind the detector's task.
struct CameraBound {
  int sensor = 0;
  // From the first picture that shows an event to the reading of the first command resting on it.
  Duration least{}, most{};
  // From the event itself: where the region of interest shows it, and where only whole pictures do.
  Duration reaction_in_region{}, reaction{};
};
// Returns the bounds of a sound mode, by camera, for one chain: by its place among rests_behind() of the task. If the
// task reads the lists of several cameras, the chain is one camera's, and so are its bounds.
//
// If time activates the task, it looks at the newest picture, which is older than the detection's beginning. Bounds then
// count from the picture. A task that a picture activates begins with it.
std::vector<CameraBound> bounds(const model::Cluster& cluster, const Detector& detector, const Mode& mode,
                                const Grid& grid, std::size_t chain);
// Returns them for an event that comes about when `before` ends and `after` begins. The first pictures are those of
// `after`.
std::vector<CameraBound> bounds_of_change(const model::Cluster& cluster, const Detector& detector, const Mode& before,
                                          const Mode& after, const Grid& grid, std::size_t chain);

}  // namespace ttf::schedules::modes
