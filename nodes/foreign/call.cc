#include "nodes/foreign/call.h"

#include <fmt/format.h>
#include <signal.h>
#include <time.h>
#include <unistd.h>

#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <stdexcept>

#include "core/check.h"
#include "core/errors.h"

namespace ttf::nodes::foreign {
namespace {

constexpr int kTicks = 10;  // in the limit of a call
constexpr int kCrashes[] = {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGTRAP, SIGSYS};
constexpr std::size_t kHandlersStack = 64 * 1024;

// The calling thread's call. Its handlers run on the same thread.
thread_local const CallTerms* volatile t_terms = nullptr;
thread_local volatile sig_atomic_t t_ticks = 0;

int tick_signal() { return SIGRTMIN + 3; }

void say(const std::string& sentence) { (void)!write(STDERR_FILENO, sentence.data(), sentence.size()); }

extern "C" void ttf_call_ticks(int) {
  const int kept = errno;
  if (const CallTerms* const terms = t_terms; terms != nullptr) {
    t_ticks = t_ticks + 1;
    if (t_ticks >= kTicks) {
      say(terms->hang);
      _exit(1);
    }
  }
  errno = kept;
}

// The default action is back already: the signal waits until this returns, and then ends the process.
extern "C" void ttf_call_crashes(int signal) {
  if (const CallTerms* const terms = t_terms; terms != nullptr) say(terms->crash);
  raise(signal);
}

// A library that calls exit() would end a drive as if all were well.
extern "C" void ttf_call_exits() {
  if (const CallTerms* const terms = t_terms; terms != nullptr) {
    say(terms->exit);
    _exit(1);
  }
}

// Once a process.
void install_handlers() {
  static const bool installed = [] {
    struct sigaction action {};
    sigemptyset(&action.sa_mask);
    action.sa_handler = ttf_call_ticks;
    action.sa_flags = SA_RESTART | SA_ONSTACK;
    sigaction(tick_signal(), &action, nullptr);
    action.sa_handler = ttf_call_crashes;
    action.sa_flags = static_cast<int>(SA_RESETHAND | SA_ONSTACK);
    for (const int signal : kCrashes) {
      struct sigaction now {};
      sigaction(signal, nullptr, &now);
      if (now.sa_handler == SIG_DFL) sigaction(signal, &action, nullptr);
    }
    if (std::atexit(ttf_call_exits) != 0 || std::at_quick_exit(ttf_call_exits) != 0)
      throw std::runtime_error("cannot watch for the end of the process in the steps' calls");
    return true;
  }();
  (void)installed;
}

// A thread's timer, and a stack for its handlers: a step may have used up its own.
class ThreadWatch {
 public:
  ThreadWatch() {
    install_handlers();
    sigset_t ticks;
    sigemptyset(&ticks);
    sigaddset(&ticks, tick_signal());
    pthread_sigmask(SIG_UNBLOCK, &ticks, nullptr);
    sigevent event{};
    event.sigev_notify = SIGEV_THREAD_ID;
    event.sigev_signo = tick_signal();
    event._sigev_un._tid = gettid();
    if (timer_create(CLOCK_MONOTONIC, &event, &timer_) != 0)
      throw std::runtime_error(fmt::format("cannot make a timer for the steps' calls: {}", system_message(errno)));
    stack_t present{};
    sigaltstack(nullptr, &present);
    if ((present.ss_flags & SS_DISABLE) == 0) return;
    stack_ = std::make_unique<std::byte[]>(kHandlersStack);
    stack_t own{};
    own.ss_sp = stack_.get();
    own.ss_size = kHandlersStack;
    sigaltstack(&own, nullptr);
  }
  ~ThreadWatch() {
    timer_delete(timer_);
    if (!stack_) return;
    stack_t none{};
    none.ss_flags = SS_DISABLE;
    sigaltstack(&none, nullptr);
  }
  ThreadWatch(const ThreadWatch&) = delete;
  ThreadWatch& operator=(const ThreadWatch&) = delete;

  // Ticks every `period`; not at all if it is zero.
  void tick(Duration period) {
    constexpr std::int64_t kSecond = 1'000'000'000;
    const timespec time{period.ns / kSecond, period.ns % kSecond};
    const itimerspec setting{time, time};
    timer_settime(timer_, 0, &setting, nullptr);
  }

 private:
  timer_t timer_{};
  std::unique_ptr<std::byte[]> stack_;
};

ThreadWatch& watch() {
  thread_local ThreadWatch own;
  return own;
}

}  // namespace

CallTerms terms_of(const std::string& place, Duration limit) {
  return {fmt::format("error: {}: a call did not return within {:g} s (--step-limit)\n", place, limit.seconds()),
          fmt::format("error: {}: a call crashed\n", place),
          fmt::format("error: {}: a call ended the process\n", place), limit};
}

Call::Call(const CallTerms& terms) {
  TTF_CHECK(t_terms == nullptr, "a call of a step within another one: {}", terms.crash);
  ThreadWatch& own = watch();
  pthread_sigmask(SIG_SETMASK, nullptr, &mask_);
  std::fegetenv(&environment_);
  std::fesetenv(FE_DFL_ENV);
  t_ticks = 0;
  t_terms = &terms;
  own.tick(Duration{terms.limit.ns / kTicks});
}

Call::~Call() {
  watch().tick({});
  t_terms = nullptr;
  pthread_sigmask(SIG_SETMASK, &mask_, nullptr);
  std::fesetenv(&environment_);
}

}  // namespace ttf::nodes::foreign
