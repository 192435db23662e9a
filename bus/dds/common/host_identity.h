// Whether two processes read the same clock: they do where one kernel runs both and neither is in a namespace of its
// own.
#pragma once

#include <cstdint>

namespace ttf::bus::dds::common {

// The same number for all processes that share this boot of the kernel, its time namespace and its network namespace
// (which stands for a host where several are played on one machine). 0, where that cannot be made out: then nobody is
// known to be on the same host.
std::uint64_t host_identity();

}  // namespace ttf::bus::dds::common
