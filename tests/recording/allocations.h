// Counts what the whole program allocates: allocations.cc replaces operator new.
#pragma once

#include <cstdint>

namespace ttf::recording {

std::int64_t allocations();  // since the program began

}  // namespace ttf::recording
