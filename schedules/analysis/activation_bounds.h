// Bounds the activations of a task by messages and sensors: all known pairs of T and J
// (processor/activations.h).
//
//   a sensor    T its period, J the difference between clocks if the cluster's time decides when it measures
//   over CAN    T the shortest time between two lists given to the CAN, J the variation of their transfer times
//   by slots    T the shortest time between two sendings, J the longest time from the start of one to its end
//   by writing  also over FlexRay, if the list's writer is known to write less often: T the shortest time between two
//               ends of its task, J the longest time from an end until the list is complete: a list that has just
//               missed its slots waits for the next ones
// A writer that itself waits for lists over FlexRay is bounded by their slots alone, since two writers might
// wait for each other. All times are in the node's own time. Faults are not considered
// (schedules/analysis/ages.h, A1). A list lost in its static slots comes with the next ones: later than J
// allows, but never closer to another list than their slots.
#pragma once

#include "schedules/analysis/processor/activations.h"
#include "schedules/model/cluster.h"

namespace ttf::schedules::analysis {

// Whether the analysis assumes that lists over FlexRay are written less often than they are sent.
enum class WritersOfLists : bool { kUnknown, kKnown };

// Bounds the activations of a task that messages or a sensor activate.
processor::ActivationBounds activation_bounds(const model::Cluster& cluster, const model::Task& task,
                                              WritersOfLists writers);

}  // namespace ttf::schedules::analysis
