// Shared by the launch tests: a temporary folder, a readable screen, and bounded waiting.
#pragma once

#include <gtest/gtest.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "cli/supervision/supervisor.h"

namespace ttf::cli::supervision {

class Launching : public testing::Test {
 protected:
  static constexpr Duration kNever = Duration::milliseconds(3'600'000);

  Launching() {
    alarm(240);               // no test may hang
    signal(SIGHUP, SIG_DFL);  // a test runner may ignore it
    std::string name = (std::filesystem::temp_directory_path() / "ttf_launch_XXXXXX").string();
    folder_ = mkdtemp(name.data());
    screen_ = memfd_create("screen", 0);
  }
  ~Launching() override {
    alarm(0);
    close(screen_);
    std::filesystem::remove_all(folder_);
  }

  static ChildCommand child(std::vector<std::string> habits) {
    habits.insert(habits.begin(), TTF_LAUNCH_CHILD);
    return {std::move(habits), {}};
  }
  std::string path(const std::string& name) const { return folder_ + "/" + name; }

  // No timeout ends these waits: the awaited event must happen.
  SupervisorConfig config(std::vector<NodeSpec> nodes) const {
    SupervisorConfig config;
    config.nodes = std::move(nodes);
    config.ready_timeout = config.optional_grace = kNever;
    config.grace = {kNever, kNever};
    config.screen = screen_;
    config.words_every = {};
    return config;
  }

  // The displayed text, without each line's time (eight characters and a blank).
  std::string shown() const {
    std::string bytes(static_cast<std::size_t>(std::filesystem::file_size("/proc/self/fd/" + std::to_string(screen_))),
                      '\0');
    EXPECT_EQ(pread(screen_, bytes.data(), bytes.size(), 0), static_cast<ssize_t>(bytes.size()));
    std::string out, line;
    for (std::istringstream lines(bytes); std::getline(lines, line);) {
      const bool timed = line.size() > 9 && line[4] == '.' && line[8] == ' ';
      out += (timed ? line.substr(9) : line) + '\n';
    }
    return out;
  }

  static std::string contents(const std::string& file) {
    std::ostringstream text;
    text << std::ifstream(file, std::ios::binary).rdbuf();
    return text.str();
  }

  // Returns true as soon as the condition holds, false after two minutes.
  static bool eventually(const std::function<bool()>& condition) {
    for (int i = 0; i < 12'000; ++i) {
      if (condition()) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return condition();
  }

  static pid_t number_in(const std::string& file) {
    pid_t number = 0;
    std::ifstream(file) >> number;
    return number;
  }

  // Gone, or dead and waiting for its adoptive parent.
  static bool is_gone(pid_t pid) {
    if (kill(pid, 0) != 0 && errno == ESRCH) return true;
    const std::string stat = contents("/proc/" + std::to_string(pid) + "/stat");
    const std::size_t name_end = stat.rfind(')');
    return name_end == std::string::npos || stat[name_end + 2] == 'Z';
  }

  static bool has_no_children() { return waitpid(-1, nullptr, WNOHANG) == -1 && errno == ECHILD; }

  std::string folder_;
  int screen_ = -1;
};

// A launch from start to end.
class Supervising : public Launching {
 protected:
  Outcome run(SupervisorConfig given, Hooks hooks = {}) {
    Supervisor supervisor(std::move(given), std::move(hooks));
    const Outcome outcome = supervisor.run();
    health_ = supervisor.health().json();
    EXPECT_TRUE(has_no_children());
    return outcome;
  }
  nlohmann::ordered_json health_;
};

}  // namespace ttf::cli::supervision
