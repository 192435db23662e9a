// Chains of cause and effect: from a sensor's picture to the actuator that acts on it, in best and worst case.
//
// A chain begins with a sensor's measuring task. It leads through lists and tasks to a task that reads commands and
// writes nothing. A command is a list that a service has written: a task that reads an image, or another list that
// descends from no single sensor. The stages and assumptions are those of schedules/analysis/ages.h; they continue from
// the image to the actuator.
//
// Marks of lanes are a list of no sensor in a cluster, so that lane keeping is a service. They come with their camera's
// own list, and take no way beside it.
//
//   reduced reaction time   from the first picture that shows an event to the start of the task that reads the first
//                           command resting on that picture, provided that the event is detected in it
//   reaction time           from the event itself: it may just have missed the picture before
//   reduced data age        the age of the newest picture that a command rests on, when the command is read
//   data age                the same at the last instant before the next command is read
// These are the four times of schedules/timing/chain/end_to_end.h, with the reading of a command as the output.
// The largest reaction time equals the largest data age: until the picture after next has an effect, the one before
// counts (Guenzel et al., "On the equivalence of maximum reaction time and maximum data age for cause-effect chains",
// ECRTS 2023). The reduced times leave out what lies before the picture, or after the reading.
//
// A detector that holds lists looks at some pictures, and not at others (AgePath::chosen). The reduced reaction time
// then begins with a picture that it looks at. How often it looks is not known here: reaction time and data age have no
// bound. schedules/modes bounds them for a table of detections.
//
// The lag of a filter is no part of a chain: the picture has its first effect on the image, not its whole one. Neither
// is the actuator's dead time, which is the vehicle's.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/ids.h"
#include "core/time.h"
#include "schedules/analysis/ages.h"
#include "schedules/model/cluster.h"

namespace ttf::schedules::analysis::chain {

struct Chain {
  SensorId sensor{};
  std::string name;  // its sensor, and every task that reads a list: "camera -> gateway.forward -> ... -> actuator.act"
  PduId command{};   // the list that the actuator reads
  AgePath path;      // its use is the actuator's reading; waypoints are those of the chain
  bool fused = false;  // its pictures come through the image, so that BUFF may hold them
  // Each measurement passes the same instants at best and at worst. Both are reached, up to the clocks' difference.
  bool exact = false;
  Duration between_pictures{};  // longest time between two measurements

  // Whether each picture has an effect. Otherwise only the reduced reaction time has a meaning, of a picture looked at.
  bool looks_at_all() const { return !path.chosen; }

  Duration reduced_reaction_best() const { return path.use_best; }
  Duration reduced_reaction_worst(bool held = false) const { return held ? path.buffered_use_worst : path.use_worst; }
  Duration reaction_worst(bool held = false) const { return reduced_reaction_worst(held) + between_pictures; }
  Duration reduced_age_worst(bool held = false) const { return held ? path.buffered_newest_worst : path.newest_worst; }
  Duration age_worst(bool held = false) const { return reaction_worst(held); }
};

// Clusters may have more; the others are left out.
inline constexpr std::size_t kMostChains = 200;

// Returns the chains in the order of Cluster::sensors and then of the tasks. The cluster must have passed check().
std::vector<Chain> chains(const model::Cluster& cluster);

// Returns the chains as a table in milliseconds, for people; empty without a chain. With a dead time, that of the
// actuator, the rows of reactions end when the vehicle is acted upon.
std::string chains_text(const model::Cluster& cluster, Duration dead_time = {});

}  // namespace ttf::schedules::analysis::chain
