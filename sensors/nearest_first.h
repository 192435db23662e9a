// Keeps a list's nearest objects where there are more than it holds.
#pragma once

#include <algorithm>
#include <vector>

namespace ttf::sensors {

// The order is stable. An object has x and y [m] from its sensor.
template <class Object> void keep_nearest(std::vector<Object>& objects, int limit) {
  if (static_cast<int>(objects.size()) <= limit) return;
  std::sort(objects.begin(), objects.end(), [](const Object& a, const Object& b) {
    const double ra = a.x * a.x + a.y * a.y, rb = b.x * b.x + b.y * b.y;
    return ra != rb ? ra < rb : a.y < b.y;
  });
  objects.erase(objects.begin() + limit, objects.end());
}

}  // namespace ttf::sensors
