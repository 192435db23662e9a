// Counts this program's heap allocations.
#pragma once

#include <cstdint>

namespace ttf::nodes {
std::int64_t allocations();
}  // namespace ttf::nodes
