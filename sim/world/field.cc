#include <fmt/format.h>

#include <cmath>
#include <cstdlib>

#include "sim/world/world.h"

namespace ttf::sim::world {

std::vector<ObjectConfig> placed(const FieldConfig& field) {
  std::vector<ObjectConfig> objects;
  const auto wanted = static_cast<std::size_t>(field.objects);
  for (int row = 0; objects.size() < wanted; ++row) {
    const double x = field.nearest + row * field.row;
    if (x > kFarthest_m) break;
    const double widest = x * std::tan(field.half_angle), aside = row % 2 == 0 ? 0.0 : 0.5 * field.across;
    for (int place = 0; objects.size() < wanted; ++place) {
      // 0, -1, 1, -2, ... from the middle.
      const int column = place % 2 == 0 ? place / 2 : -(place + 1) / 2;
      const double y = aside + column * field.across;
      if (std::abs(y) > widest || std::abs(y) > kFarthest_m) break;
      ObjectConfig& object = objects.emplace_back(field.each);
      object.name = fmt::format("field_{:04}", objects.size() - 1);
      object.x = x;
      object.y = y;
    }
  }
  return objects;
}

}  // namespace ttf::sim::world
