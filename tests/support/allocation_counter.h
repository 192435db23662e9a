// Counts what the whole test program allocates: allocation_counter.cc, linked in, replaces every form of
// operator new (over-aligned ones too: containers of fixed-size Eigen types use them).
#pragma once

#include <cstdint>

namespace ttf::support {

std::int64_t allocations();  // since the program began
std::int64_t live_bytes();   // allocated and not released

}  // namespace ttf::support
