// Requests to the kernel, in separate processes with different limits on locked memory.
#include "nodes/runner/thread_privileges.h"

#include <gtest/gtest.h>
#include <linux/capability.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <functional>
#include <string>

namespace ttf::nodes::runner {
namespace {

constexpr std::size_t kPlace = 1'000'000;  // beyond all processors: it takes no processor
constexpr std::size_t kLater = 64 << 20;

// g++ has macros for it, clang features.
#if defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define TTF_SANITIZED
#endif
#elif defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define TTF_SANITIZED
#endif
#if defined(TTF_SANITIZED)
constexpr bool kLocks = false;  // sanitizers forbid locking memory
#else
constexpr bool kLocks = true;
#endif

bool give_up_locking() {
  __user_cap_header_struct header{_LINUX_CAPABILITY_VERSION_3, 0};
  __user_cap_data_struct data[2]{};
  if (syscall(SYS_capget, &header, data) != 0) return false;
  data[0].effective &= ~(1u << CAP_IPC_LOCK);
  data[0].permitted &= ~(1u << CAP_IPC_LOCK);
  return syscall(SYS_capset, &header, data) == 0;
}

bool set_limit(rlim_t bytes) {
  const rlimit limit{bytes, bytes};
  return setrlimit(RLIMIT_MEMLOCK, &limit) == 0;
}

// The sentence about memory; empty if there is none.
std::string asked() {
  std::string found;
  for (const std::string& sentence : ask_for_thread_privileges(kPlace, kPlace))
    if (sentence.starts_with("memory")) found += sentence;
  const sched_param none{};
  sched_setscheduler(0, SCHED_OTHER, &none);  // the rest of the test is in no hurry
  return found;
}

// Whether as much as a program asks for later is there.
bool more_is_there() {
  void* const more = mmap(nullptr, kLater, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (more == MAP_FAILED) return false;
  std::memset(more, 1, kLater);
  return true;
}

std::uint64_t locked_kib() {
  std::ifstream status("/proc/self/status");
  std::uint64_t kib = 0;
  for (std::string word; status >> word;)
    if (word == "VmLck:") status >> kib;
  return kib;
}

// Runs `what` in a separate process: 0 well, 77 it cannot be tried here, else it fails.
int alone(const std::function<int()>& what) {
  const pid_t process = fork();
  if (process == 0) _exit(what());
  int status = 0;
  waitpid(process, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

int failed(const std::string& why) {
  std::fprintf(stderr, "%s\n", why.c_str());
  return 1;
}

// Turns alone()'s result into the test's.
#define TRY_ALONE(what)                                                         \
  if (!kLocks) GTEST_SKIP() << "sanitizers let nobody lock memory";             \
  const int code = alone(what);                                                 \
  if (code == 77) GTEST_SKIP() << "limits or privileges cannot be set so here"; \
  EXPECT_EQ(code, 0)

TEST(ThreadPrivileges, UnderALimitThatIsTooSmallNothingIsLocked) {
  TRY_ALONE([] {
    if (!give_up_locking() || !set_limit(64 << 10)) return 77;
    const std::string said = asked();
    if (said !=
        "memory is not locked: it exceeds the limit of 64 KiB (allow it: ulimit -l unlimited, or "
        "CAP_IPC_LOCK)")
      return failed(said);
    if (locked_kib() != 0) return failed("something is locked");
    return more_is_there() ? 0 : failed("later memory is refused");
  });
}

TEST(ThreadPrivileges, UnderALimitThatWillDoOnlyWhatIsThereIsLocked) {
  TRY_ALONE([] {
    if (!set_limit(512 << 20) || !give_up_locking()) return 77;
    const std::string said = asked();
    if (!said.starts_with("only memory allocated before the start is locked: later memory may exceed the limit of "
                          "524288 KiB (allow it:"))
      return failed(said);
    const std::uint64_t locked = locked_kib();
    if (locked == 0) return failed("nothing is locked");
    if (!more_is_there()) return failed("later memory is refused");
    return locked_kib() < locked + kLater / 1024 ? 0 : failed("later memory is locked");
  });
}

TEST(ThreadPrivileges, APrivilegedProcessLocksAllWhateverTheLimit) {
  TRY_ALONE([] {
    if (!set_limit(0) || mlock("", 1) != 0) return 77;
    munlock("", 1);
    const std::string said = asked();
    if (!said.empty()) return failed(said);
    const std::uint64_t locked = locked_kib();
    if (!more_is_there()) return failed("later memory is refused");
    rlimit limit{};
    if (getrlimit(RLIMIT_MEMLOCK, &limit) != 0 || limit.rlim_cur != 0) return failed("another limit than before");
    return locked > 0 && locked_kib() >= locked + kLater / 1024 ? 0 : failed("later memory is not locked");
  });
}

TEST(ThreadPrivileges, WithoutALimitAllIsLocked) {
  TRY_ALONE([] {
    if (!set_limit(RLIM_INFINITY) || !give_up_locking()) return 77;
    const std::string said = asked();
    if (!said.empty()) return failed(said);
    const std::uint64_t locked = locked_kib();
    return more_is_there() && locked_kib() >= locked + kLater / 1024 ? 0 : failed("later memory is not locked");
  });
}

}  // namespace
}  // namespace ttf::nodes::runner
