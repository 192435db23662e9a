// How often messages and sensors may activate a task: every T and J (processor/activations.h) that is known.
//
//   a sensor    T its period, J what clocks differ by where the cluster's time says when it measures
//   over CAN    T the shortest time between two lists that the CAN is told of, J by how much their transfers differ
//   by slots    T the shortest time between two sendings, J how much later than its first slot begins one may be over
//   by writing  over FlexRay as well, where the list's writer is known to write less often: T the shortest time between
//               two ends of its task, J the longest from one on until the list is complete: a list that has just missed
//               its slots is sent in the next ones
// A writer that waits for lists over FlexRay itself is taken to wait for their slots alone, as two might wait for each
// other. All in a node's own time. Nothing fails (schedules/analysis/ages.h, A1): a list that was lost in its static
// slots comes with the next ones, later than J says, though never closer to another than their slots.
#pragma once

#include "schedules/analysis/processor/activations.h"
#include "schedules/model/cluster.h"

namespace ttf::schedules::analysis {

// Whether lists over FlexRay are known to be written less often than they are sent.
enum class WritersOfLists : bool { kUnknown, kKnown };

// Of a task that messages or a sensor activate.
processor::ActivationBounds activation_bounds(const model::Cluster& cluster, const model::Task& task,
                                              WritersOfLists writers);

}  // namespace ttf::schedules::analysis
