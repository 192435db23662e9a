// Asks an ordinary kernel for timely wake-ups of a process, and reports each refusal.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace ttf::nodes::runner {

// Asks for the calling thread and its process: SCHED_FIFO, no timer slack, locked memory, and a processor of
// its own. The processor is taken by `place` (0, 1, ...) if there is one more than `processes`. Memory
// allocated later is locked, too, unless RLIMIT_MEMLOCK limits it: there, allocation could fail. Returns one
// sentence for each refusal, with advice; the process works without them.
std::vector<std::string> ask_for_thread_privileges(std::size_t place, std::size_t processes);

}  // namespace ttf::nodes::runner
