// The child that the launch tests start: one habit per word on its command line, done one after the other.
//
//   launch_child ready start print:48690a exit:3
//
//   ready            reports that                  start          waits for the start message
//   tell:TEXT        sends any message             print:HEX      bytes to standard output
//   flood:BYTES      'x', without a newline        where          prints its descriptors and environment
//   ignore:SIGNAL    from here on                    report:SIGNAL  {"health": {"state": "asked N"}} whenever it comes
//   raise:SIGNAL     kills or stops itself         wait           for ever
//   exit:CODE        ends                          on:SIGNAL:CODE ends so when it comes
//   pid:FILE         its number, into a file       descend:FILE   a child of its own, which waits for ever
//   try:FILE:N       exit 7 unless this is the N-th time
//   supervise:DIR    supervises a process that waits, as does that one's own child; their numbers are in DIR/child and
//                    DIR/grandchild
#include <signal.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <string_view>

#include "cli/supervision/control.h"
#include "tests/cli/supervision/launch_child_processes.h"

namespace {

using ttf::cli::supervision::ControlLine;

volatile sig_atomic_t reported = 0;
int control_fd = -1;
int code_on_signal = 0;

void print(std::string_view text) {
  while (!text.empty()) {
    const ssize_t written = write(STDOUT_FILENO, text.data(), text.size());
    if (written <= 0) _exit(99);
    text.remove_prefix(static_cast<std::size_t>(written));
  }
}

std::string unhex(const std::string& hex) {
  std::string bytes;
  for (std::size_t i = 0; i + 1 < hex.size(); i += 2)
    bytes += static_cast<char>(std::stoi(hex.substr(i, 2), nullptr, 16));
  return bytes;
}

// Without a supervisor, the tests' child has no purpose.
ControlLine& line() {
  static auto control = ControlLine::from_environment();
  if (!control) _exit(98);
  return *control;
}

void wait_for_ever() {
  sigset_t none;
  sigemptyset(&none);
  for (;;) {
    sigsuspend(&none);
    if (reported != 0) line().health({{"state", "asked " + std::to_string(std::exchange(reported, 0))}});
  }
}

void do_habit(const std::string& word, const std::string& value) {
  const auto signal_given = [&] { return std::stoi(value); };
  if (word == "ready") {
    line().ready();
  } else if (word == "start") {
    const auto facts = line().wait_for_start();
    print(facts ? "start " + facts->dump() + "\n" : "nobody says start\n");
  } else if (word == "tell") {
    ttf::cli::supervision::report(control_fd, value);
  } else if (word == "print") {
    print(unhex(value));
  } else if (word == "flood") {
    const std::string piece(1000, 'x');
    for (long left = std::stol(value); left > 0; left -= 1000)
      print(std::string_view(piece).substr(0, static_cast<std::size_t>(std::min(left, 1000L))));
  } else if (word == "where") {
    print(ttf::cli::supervision::surroundings(control_fd));
  } else if (word == "ignore") {
    signal(signal_given(), SIG_IGN);
  } else if (word == "report") {
    // Blocked except while waiting, so that no signal is missed.
    sigset_t held;
    sigemptyset(&held);
    sigaddset(&held, signal_given());
    sigprocmask(SIG_BLOCK, &held, nullptr);
    signal(signal_given(), [](int which) { reported = which; });
  } else if (word == "on") {
    code_on_signal = std::stoi(value.substr(value.find(':') + 1));
    signal(std::stoi(value), [](int) { _exit(code_on_signal); });
  } else if (word == "raise") {
    raise(signal_given());
  } else if (word == "wait") {
    wait_for_ever();
  } else if (word == "exit") {
    _exit(std::stoi(value));
  } else if (word == "pid") {
    ttf::cli::supervision::leave_number(value, getpid());
  } else if (word == "descend") {
    ttf::cli::supervision::descend(value);
  } else if (word == "try") {
    const std::size_t colon = value.rfind(':');
    if (ttf::cli::supervision::times(value.substr(0, colon)) != std::stoi(value.substr(colon + 1))) _exit(7);
  } else if (word == "supervise") {
    _exit(ttf::cli::supervision::supervise(value));
  } else {
    _exit(97);
  }
}

}  // namespace

int main(int count, char** arguments) {
  // line() takes it out of the environment.
  if (const char* const number = std::getenv("TTF_CONTROL_FD"); number != nullptr) control_fd = std::atoi(number);
  for (int i = 1; i < count; ++i) {
    const std::string habit = arguments[i];
    const std::size_t colon = habit.find(':');
    do_habit(habit.substr(0, colon), colon == std::string::npos ? "" : habit.substr(colon + 1));
  }
  return 0;
}
