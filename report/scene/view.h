// A scene at one instant. Its rules stand here alone: the page's data (packed.h) has their results.
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "report/scene/scene.h"

namespace ttf::report::scene {

// A moment counts until the next one of its kind, and at most so long: truth, images and warnings; a sensor's lists; the
// vehicle's motion.
inline constexpr Duration kObjectLife = Duration::milliseconds(1000), kListLife = Duration::milliseconds(300),
                          kOwnLife{std::numeric_limits<std::int64_t>::max()};
inline constexpr Duration kTrail = Duration::milliseconds(2000);

struct View {
  std::vector<TrueObject> truth;           // between two instants of the log: on the straight line between them
  std::vector<ShownTrack> tracks;          // the newest image's; moved on by their velocity and the vehicle's since
  OwnMotion own;                           // at that image; none if its velocities are relative to the vehicle
  std::vector<std::vector<Point>> lists;   // by SensorId
  std::vector<Warning> warnings;           // those that name one of the tracks
  std::vector<std::vector<Point>> trails;  // each track's places in images at most kTrail old, the oldest first
};
View view_at(const Scene& scene, TrueTime at);

// Returns whether the moment at this place counts until the next one.
template <class Part>
bool counts_until_next(const std::vector<Moment<Part>>& moments, std::size_t place, Duration life) {
  return place + 1 < moments.size() && moments[place + 1].at - moments[place].at <= life;
}

// Returns the track's place so many seconds later, in the axes that the vehicle has then.
Pose moved_on(const View& view, const ShownTrack& track, double seconds);

// Returns "collision in 1.2 s", "gap of 0.4 s" or "warning".
std::string words_of(const Warning& warning);

}  // namespace ttf::report::scene
