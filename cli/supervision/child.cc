#include "cli/supervision/child.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <linux/close_range.h>
#include <signal.h>
#include <sys/ioctl.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <termios.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <string_view>

#include "cli/supervision/control.h"
#include "core/errors.h"

namespace ttf::cli::supervision {
namespace {

[[noreturn]] void system_fails(std::string_view what) {
  throw std::runtime_error(fmt::format("{}: {}", what, system_message(errno)));
}

int checked(int result, std::string_view what) {
  if (result < 0) system_fails(what);
  return result;
}

struct Pair {
  Descriptor ours, childs;
};

// If one of 0..2 is closed, the next opened file would become standard input, output or error.
void fill_standard_descriptors() {
  for (;;) {
    Descriptor filler(open("/dev/null", O_RDWR));
    if (filler.get() < 0 || filler.get() > STDERR_FILENO) return;
    filler.release();
  }
}

// Opening the slave through its master, not by its path, is right in any mount namespace.
Pair raw_terminal() {
  Pair pair;
  pair.ours =
      Descriptor(checked(posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC | O_NONBLOCK), "cannot open a pseudo terminal"));
  checked(unlockpt(pair.ours.get()), "cannot open a pseudo terminal");
  pair.childs = Descriptor(
      checked(ioctl(pair.ours.get(), TIOCGPTPEER, O_RDWR | O_NOCTTY | O_CLOEXEC), "cannot open a pseudo terminal"));
  termios settings{};
  checked(tcgetattr(pair.childs.get(), &settings), "cannot set up a pseudo terminal");
  cfmakeraw(&settings);
  checked(tcsetattr(pair.childs.get(), TCSANOW, &settings), "cannot set up a pseudo terminal");
  return pair;
}

Pair control_line() {
  int ends[2];
  checked(socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends), "cannot open a socket pair");
  Pair pair{Descriptor(ends[0]), Descriptor(ends[1])};
  checked(fcntl(ends[0], F_SETFL, O_NONBLOCK), "cannot set up a socket pair");  // the child waits on its own end
  return pair;
}

// Arguments for exec, built before the fork: after it, a process with threads must not allocate memory.
class Strings {
 public:
  void add(std::string text) { texts_.push_back(std::move(text)); }
  // Replaces earlier entries "NAME=..." of the same name.
  void set(const std::string& name, const std::string& value) {
    std::erase_if(texts_, [&](const std::string& text) { return text.starts_with(name + "="); });
    texts_.push_back(name + "=" + value);
  }
  char** array() {
    pointers_.clear();
    for (std::string& text : texts_) pointers_.push_back(text.data());
    pointers_.push_back(nullptr);
    return pointers_.data();
  }

 private:
  std::vector<std::string> texts_;
  std::vector<char*> pointers_;
};

// The child's work before exec, in system calls only. It ends by exec, or by writing errno to `report`.
struct Launchpad {
  char** arguments = nullptr;
  char** environment = nullptr;
  int terminal = -1, control = -1, report = -1, nothing = -1;
  pid_t parent = -1;

  [[noreturn]] void run() const {
    // The parent may have died before this call.
    if (prctl(PR_SET_PDEATHSIG, SIGKILL) != 0 || getppid() != parent) _exit(127);
    setsid();
    ioctl(terminal, TIOCSCTTY, 0);  // its hang-up ends the group, even after the supervisor is killed
    dup2(nothing, STDIN_FILENO);
    dup2(terminal, STDOUT_FILENO);
    dup2(terminal, STDERR_FILENO);
    close_range(3, ~0u, CLOSE_RANGE_CLOEXEC);
    fcntl(control, F_SETFD, 0);
    // Ignored signals and the mask survive exec: without this, the program could not be interrupted.
    for (const int signal :
         {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGPIPE, SIGCHLD, SIGUSR1, SIGUSR2, SIGTSTP, SIGTTIN, SIGTTOU})
      ::signal(signal, SIG_DFL);
    sigset_t none;
    sigemptyset(&none);
    sigprocmask(SIG_SETMASK, &none, nullptr);
    execvpe(arguments[0], arguments, environment);
    const int reason = errno;
    (void)!write(report, &reason, sizeof reason);
    _exit(127);
  }
};

// Returns errno of a failed exec; 0 if exec closed the pipe.
int start_error(int report) {
  int reason = 0;
  ssize_t got = 0;
  do got = read(report, &reason, sizeof reason);
  while (got < 0 && errno == EINTR);
  return got == sizeof reason ? reason : 0;
}

}  // namespace

std::string Ending::text() const {
  if (!by_signal) return fmt::format("exit {}{}", value, without_result ? " without its result" : "");
  const char* const words = sigdescr_np(value);
  return fmt::format("signal {} ({})", value, words != nullptr ? words : "unknown");
}

Child::Child(const ChildCommand& command) {
  fill_standard_descriptors();
  Pair terminal = raw_terminal();
  Pair control = control_line();
  const Descriptor nothing(checked(open("/dev/null", O_RDONLY | O_CLOEXEC), "/dev/null"));
  int pipe_ends[2];
  checked(pipe2(pipe_ends, O_CLOEXEC), "cannot open a pipe");
  const Descriptor report(pipe_ends[0]);
  Descriptor report_in(pipe_ends[1]);

  Strings arguments, environment;
  for (const std::string& argument : command.arguments) arguments.add(argument);
  for (char** entry = environ; *entry != nullptr; ++entry) environment.add(*entry);
  environment.set("NO_COLOR", "1");  // escape sequences would appear as text
  for (const auto& [name, value] : command.environment) environment.set(name, value);
  environment.set(std::string(kControlVariable), fmt::to_string(control.childs.get()));

  const Launchpad pad{arguments.array(),
                      environment.array(),
                      terminal.childs.get(),
                      control.childs.get(),
                      report_in.get(),
                      nothing.get(),
                      getpid()};
  pid_ = checked(fork(), "cannot start a process");
  if (pid_ == 0) pad.run();
  report_in.close();
  // By its number, because the header of glibc 2.36 declares the function without C linkage.
  process_ = Descriptor(static_cast<int>(syscall(SYS_pidfd_open, pid_, 0)));
  output_ = std::move(terminal.ours);
  control_ = std::move(control.ours);
  const int no_watch = process_.open() ? 0 : errno;
  const int reason = start_error(report.get());
  if (no_watch == 0 && reason == 0) return;
  kill(pid_, SIGKILL);
  waitpid(pid_, nullptr, 0);
  if (reason == 0) throw std::runtime_error(fmt::format("cannot open a pidfd: {}", system_message(no_watch)));
  throw StartFailure(fmt::format("{}: cannot be started: {}", command.arguments[0], system_message(reason)),
                     {false, reason == ENOENT ? 127 : 126});
}

Child::~Child() {
  if (reaped_) return;
  signal_group(SIGKILL);
  // Waits for the death, then kills the group's other members before the number is free again.
  siginfo_t info{};
  while (waitid(P_PID, static_cast<id_t>(pid_), &info, WEXITED | WNOWAIT) != 0 && errno == EINTR) {
  }
  reap();
}

void Child::signal_group(int signal) {
  // Between fork and setsid the group does not exist, but start_error() has waited for the later exec.
  if (!reaped_) kill(-pid_, signal);
}

std::string Child::read_output(std::size_t most) {
  std::string bytes(most, '\0');
  const ssize_t got = read(output_.get(), bytes.data(), bytes.size());
  // EIO: the other end is closed everywhere, and all output has been read.
  if (got == 0 || (got < 0 && errno != EAGAIN && errno != EINTR)) output_over_ = true;
  bytes.resize(got > 0 ? static_cast<std::size_t>(got) : 0);
  return bytes;
}

std::optional<std::string> Child::read_control() {
  if (!control_.open()) return std::nullopt;
  std::string message(kLongestMessage, '\0');
  const ssize_t got = recv(control_.get(), message.data(), message.size(), MSG_DONTWAIT);
  // An empty packet looks like the end, but has no meaning here.
  if (got == 0 || (got < 0 && errno != EAGAIN && errno != EINTR)) control_.close();
  if (got <= 0) return std::nullopt;
  message.resize(static_cast<std::size_t>(got));
  return message;
}

bool Child::send_control(const std::string& message) {
  return control_.open() && send(control_.get(), message.data(), message.size(), MSG_DONTWAIT | MSG_NOSIGNAL) ==
                                static_cast<ssize_t>(message.size());
}

std::optional<Ending> Child::reap() {
  if (reaped_) return std::nullopt;
  siginfo_t info{};
  if (waitid(P_PID, static_cast<id_t>(pid_), &info, WEXITED | WNOHANG | WNOWAIT) != 0 || info.si_pid == 0)
    return std::nullopt;
  signal_group(SIGKILL);  // while the dead leader still holds the group's number
  waitpid(pid_, nullptr, 0);
  reaped_ = true;
  return Ending{info.si_code != CLD_EXITED, info.si_status};
}

}  // namespace ttf::cli::supervision
