#include "nodes/runner/thread_privileges.h"

#include <fmt/format.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <fstream>
#include <system_error>
#include <utility>

namespace ttf::nodes::runner {
namespace {

constexpr std::uint64_t kStackRoom = 8 << 20;  // the usual limit of a stack's growth
constexpr int kPriority = 50;                  // below the kernel threads that carry interrupts on real-time kernels

std::string words_of(int error) { return std::system_category().message(error); }

std::string pin(std::size_t place, std::size_t processes) {
  cpu_set_t allowed;
  CPU_ZERO(&allowed);
  if (sched_getaffinity(0, sizeof allowed, &allowed) != 0) return "not pinned to a processor: " + words_of(errno);
  const auto count = static_cast<std::size_t>(CPU_COUNT(&allowed));
  if (count <= processes)
    return fmt::format("not pinned to a processor: {} processes need {} processors, and {} are allowed", processes,
                       processes + 1, count);
  // The first processor is left to all other processes.
  std::size_t nth = 0;
  for (int cpu = 0; cpu < CPU_SETSIZE; ++cpu) {
    if (!CPU_ISSET(cpu, &allowed) || nth++ != place + 1) continue;
    cpu_set_t one;
    CPU_ZERO(&one);
    CPU_SET(cpu, &one);
    if (sched_setaffinity(0, sizeof one, &one) != 0) return "not pinned to a processor: " + words_of(errno);
    return {};
  }
  return "not pinned to a processor: there are fewer processors than nodes";
}

// Tries it, because a container may show capabilities that have no effect: under a limit of zero, only a
// privileged process can lock a page.
bool may_lock_beyond(const rlimit& limit) {
  const rlimit nothing{0, limit.rlim_max};
  if (setrlimit(RLIMIT_MEMLOCK, &nothing) != 0) return false;
  const bool may = mlock(&nothing, sizeof nothing) == 0;
  if (may) munlock(&nothing, sizeof nothing);
  setrlimit(RLIMIT_MEMLOCK, &limit);
  return may;
}

// The process's address space in bytes, all of which would be locked.
std::uint64_t size_now() {
  std::uint64_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  return pages * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

constexpr const char* kLockHelp = "(allow it: ulimit -l unlimited, or CAP_IPC_LOCK)";

// Under a limit, locking future memory would make later allocations fail, and end a thread whose stack grows.
// Then only present memory is locked, if it fits together with a grown stack.
std::string lock_memory() {
  rlimit limit{};
  if (getrlimit(RLIMIT_MEMLOCK, &limit) != 0) return "memory is not locked: " + words_of(errno);
  if (limit.rlim_cur == RLIM_INFINITY || may_lock_beyond(limit)) {
    if (mlockall(MCL_CURRENT | MCL_FUTURE) == 0) return {};
    return fmt::format("memory is not locked: {} {}", words_of(errno), kLockHelp);
  }
  // Without figures of this process: the same sentence from several processes is shown once.
  const std::string most = fmt::format("the limit of {} KiB", limit.rlim_cur / 1024);
  if (size_now() + kStackRoom > limit.rlim_cur)
    return fmt::format("memory is not locked: it exceeds {} {}", most, kLockHelp);
  if (mlockall(MCL_CURRENT) != 0) return fmt::format("memory is not locked: {} {}", words_of(errno), kLockHelp);
  return fmt::format("only memory allocated before the start is locked: later memory may exceed {} {}", most,
                     kLockHelp);
}

}  // namespace

std::vector<std::string> ask_for_thread_privileges(std::size_t place, std::size_t processes) {
  std::vector<std::string> refused;
  const sched_param priority{.sched_priority = kPriority};
  if (sched_setscheduler(0, SCHED_FIFO, &priority) != 0)
    refused.push_back(
        fmt::format("no real-time priority: {} (allow it: ulimit -r {}, or CAP_SYS_NICE)", words_of(errno), kPriority));
  if (prctl(PR_SET_TIMERSLACK, 1UL, 0UL, 0UL, 0UL) != 0)
    refused.push_back("the slack of timers is not reduced: " + words_of(errno));
  if (std::string why = lock_memory(); !why.empty()) refused.push_back(std::move(why));
  if (std::string why = pin(place, processes); !why.empty()) refused.push_back(std::move(why));
  return refused;
}

}  // namespace ttf::nodes::runner
