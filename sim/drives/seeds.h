// The seeds of a drive's random streams, in files and on the command line.
#pragma once

#include <cstdint>

#include "core/strict_yaml.h"

namespace ttf::sim::drives {

inline constexpr Range<std::int64_t> kSeeds{0, std::int64_t{1} << 62};

}  // namespace ttf::sim::drives
