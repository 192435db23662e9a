// Identifies processes that read the same clock: those of one kernel and of the same namespaces.
#pragma once

#include <cstdint>

namespace ttf::bus::dds::common {

// Returns the same number for all processes of this boot of the kernel in the same time and network
// namespaces. (A network namespace stands for a machine where one machine plays several.) 0 if unknown: then
// no process counts as on the same machine.
std::uint64_t host_identity();

}  // namespace ttf::bus::dds::common
