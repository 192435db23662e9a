// What a process asks of an ordinary kernel to be woken up in time, and what it gets.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace ttf::nodes::runner {

// For the calling thread, and the process' memory: SCHED_FIFO, no timer slack, memory locked, one processor of its own
// where there are enough for `processes` and one besides, taken by `place` (0, 1, ...). What the process takes later is
// locked, too, but where RLIMIT_MEMLOCK is a limit to it: there it would not get it. One sentence for each that was not
// granted, with what would help; all of them are done without.
std::vector<std::string> ask_for_thread_privileges(std::size_t place, std::size_t processes);

}  // namespace ttf::nodes::runner
