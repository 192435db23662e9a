// Counts the whole test program's allocations. allocation_counter.cc, linked in, replaces every form of
// operator new (also over-aligned ones: containers of fixed-size Eigen types use them).
#pragma once

#include <cstdint>

namespace ttf::support {

std::int64_t allocations();  // since the program began
std::int64_t live_bytes();   // allocated and not released

}  // namespace ttf::support
