#include "tests/cli/supervision/launch_child_processes.h"

#include <fcntl.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <termios.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "cli/supervision/supervisor.h"

namespace ttf::cli::supervision {

void report(int control_fd, const std::string& text) {
  if (send(control_fd, text.data(), text.size(), 0) < 0) _exit(96);
}

void leave_number(const std::string& path, pid_t number) {
  std::ofstream(path + ".new") << number << '\n';
  std::filesystem::rename(path + ".new", path);
}

void descend(const std::string& path) {
  if (fork() != 0) return;
  leave_number(path, getpid());
  for (;;) pause();
}

int times(const std::string& path) {
  std::ofstream(path, std::ios::app) << 'x';
  return static_cast<int>(std::filesystem::file_size(path));
}

std::string surroundings(int control_fd) {
  const auto word = [](bool yes) { return yes ? std::string("yes") : std::string("no"); };
  struct stat null {
  }, in{};
  stat("/dev/null", &null);
  fstat(STDIN_FILENO, &in);
  termios settings{};
  tcgetattr(STDOUT_FILENO, &settings);
  const char* const colour = std::getenv("NO_COLOR");
  int others = 0;
  for (int fd = 3; fd < 256; ++fd)
    if (fd != control_fd && fcntl(fd, F_GETFD) >= 0) ++others;
  return "input from nothing: " + word(in.st_rdev == null.st_rdev) +
         "\noutput on a terminal: " + word(isatty(1) != 0 && isatty(2) != 0) +
         "\nraw: " + word((settings.c_oflag & OPOST) == 0) +
         "\nleads its session and group: " + word(getsid(0) == getpid() && getpgrp() == getpid()) +
         "\nno colour: " + (colour != nullptr ? colour : "-") +
         "\nmood: " + (std::getenv("MOOD") != nullptr ? std::getenv("MOOD") : "-") +
         "\nother descriptors: " + std::to_string(others) + "\n";
}

int supervise(const std::string& folder) {
  SupervisorConfig config;
  config.screen = -1;
  const std::string self = std::filesystem::read_symlink("/proc/self/exe").string();
  config.nodes.push_back(
      {"node",
       Policy::kRequired,
       {{self, "descend:" + folder + "/grandchild", "pid:" + folder + "/child", "ready", "wait"}, {}}});
  return Supervisor(std::move(config), {}).run().exit_code;
}

}  // namespace ttf::cli::supervision
