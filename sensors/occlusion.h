// The objects that others hide from a sensor at the origin.
//
// A line of sight can only meet objects whose silhouettes hold its azimuth. The lines are taken in the order of their
// azimuths, and the objects that the present line can meet are kept by their distance. So n objects take about n log n
// steps instead of n^2. The ray itself decides (hides()), so the result is that of trying all pairs, to the bit.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "sensors/scene.h"

namespace ttf::sensors {

// The line of sight to an object.
struct Sight {
  double bearing = 0.0;     // [rad], within a quarter turn of the x axis
  double range = 0.0;       // [m], to the seen part of the object
  double half_width = 0.0;  // [rad], of its silhouette, which lies evenly about the bearing
  bool has_silhouette = false;
  bool wanted = false;  // whether to look along it; has_silhouette then
};

// Returns whether an object hides the end of a line of sight. It hides all behind it up to the share `shadow` of its
// own distance.
bool hides(const ObjectState& object, double bearing, double range, double shadow);

class Occlusion {
 public:
  // Allocates for that many objects.
  explicit Occlusion(std::size_t most_objects);
  // Returns, for each object, whether its sight is wanted and another object hides it. Valid until the next call.
  std::span<const char> hidden(std::span<const ObjectState> objects, std::span<const Sight> sights, double shadow);
  // Returns the number of pairs that the last call tried.
  std::uint64_t tried() const { return tried_; }

 private:
  struct Mark {
    double at = 0.0;
    std::size_t object = 0;
  };
  static void sort(std::vector<Mark>& marks);
  void mark(std::span<const ObjectState> objects, std::span<const Sight> sights);
  void set_crossed(std::size_t place, bool crossed);
  std::size_t next_crossed(std::size_t from) const;
  bool is_hidden(std::span<const ObjectState> objects, std::size_t object, const Sight& sight, double shadow);

  std::size_t most_, leaves_;
  double reach_ = 0.0;  // the largest outline reaches so far from its centre
  std::vector<Mark> by_distance_, by_low_, by_high_, by_bearing_;
  std::vector<std::size_t> place_;  // by object: its index in by_distance_
  // A binary tree over the places: whether the present line can meet any object below a node. Its root is node 1.
  std::vector<char> crossed_;
  std::vector<char> hidden_;
  std::uint64_t tried_ = 0;
};

}  // namespace ttf::sensors
