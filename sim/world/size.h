// The size of an object: as its configuration says, or drawn once for each drive.
//
// A drawn size is constant through the drive. It depends on the seed, the replication and the object alone, so that
// compared drives have the same cars and no other draw moves. The normal draw is of length and width together, with
// their correlation, and is repeated while a value lies outside the limits. Its defaults are those of the 93 cars of
// 1993 that R's package MASS lists (Cars93: Lock, "1993 New Car Data", Journal of Statistics Education 1, 1993): means,
// standard deviations and correlation. The limits lie beyond 4.4 standard deviations: they keep out what is no car, and
// leave the moments alone. The uniform draw is of length and width, each for itself.
#pragma once

#include <cstdint>

#include "core/ids.h"
#include "core/strict_yaml.h"

namespace ttf::sim::world {

struct Size {
  double length = 0.0, width = 0.0;  // [m]
};

struct SizeLimits {
  double shortest = 0.0, longest = 0.0, narrowest = 0.0, widest = 0.0;  // [m]
};

enum class SizeDraw : std::uint8_t { kNominal, kNormal, kUniform };

struct SizeConfig {
  SizeDraw draw = SizeDraw::kNominal;
  // The normal draw.
  Size mean{4.65, 1.76}, sigma{0.37, 0.10};
  double correlation = 0.82;
  SizeLimits normal{3.0, 6.5, 1.3, 2.2};
  SizeLimits uniform{3.79, 5.01, 1.59, 2.01};
};
// Reads `draw`, `normal` and `uniform`. The normal draw's limits leave a standard deviation to either side of the mean.
SizeConfig load_size(YamlMap& yaml);

struct ObjectKey {
  std::uint64_t seed = 0;
  std::uint32_t replication = 0;
  ObjectId object{};
};
// Returns the object's size in this drive: `nominal`, or a drawn one.
Size drawn_size(const SizeConfig& config, const Size& nominal, const ObjectKey& key);

}  // namespace ttf::sim::world
