// The example listener and a publisher as processes, and the listener's output.
#pragma once

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/check.h"
#include "tests/bus/dds/ros/drawn.h"

namespace ttf::bus::dds::ros {

// A process that ends with the test. Its stdout can be read line by line.
class Process {
 public:
  // `variables`: set in its environment, "KEY=value".
  Process(std::vector<std::string> words, std::vector<std::string> variables) {
    int ends[2];
    TTF_CHECK(pipe2(ends, O_CLOEXEC) == 0);
    output_ = ends[0];
    std::vector<char*> arguments, environment;
    for (std::string& word : words) arguments.push_back(word.data());
    for (std::string& variable : variables) environment.push_back(variable.data());
    for (char** variable = environ; *variable != nullptr; ++variable)
      if (std::string_view(*variable).substr(0, 15) != "CYCLONEDDS_URI=") environment.push_back(*variable);
    arguments.push_back(nullptr);
    environment.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
    TTF_CHECK(posix_spawn(&process_, arguments[0], &actions, nullptr, arguments.data(), environment.data()) == 0);
    posix_spawn_file_actions_destroy(&actions);
    close(ends[1]);
  }
  ~Process() {
    signal(SIGKILL);
    wait();
    close(output_);
  }
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  void signal(int number) const {
    if (!ended_) kill(process_, number);
  }
  // Its exit code, or minus the signal that ended it.
  int wait() {
    if (std::exchange(ended_, true)) return status_;
    int status = 0;
    TTF_CHECK(waitpid(process_, &status, 0) == process_);
    return status_ = WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  }
  // The next line, without its end; empty after `patience` or at the end of its output.
  std::optional<std::string> line(std::chrono::milliseconds patience) {
    const auto until = std::chrono::steady_clock::now() + patience;
    while (true) {
      if (const std::size_t end = said_.find('\n'); end != std::string::npos) {
        std::string line = said_.substr(0, end);
        said_.erase(0, end + 1);
        return line;
      }
      const auto left = std::chrono::ceil<std::chrono::milliseconds>(until - std::chrono::steady_clock::now());
      pollfd readable{output_, POLLIN, 0};
      if (poll(&readable, 1, static_cast<int>(std::max<std::int64_t>(left.count(), 0))) <= 0) return {};
      char buffer[65536];
      const ssize_t got = read(output_, buffer, sizeof buffer);
      if (got <= 0) return {};
      said_.append(buffer, static_cast<std::size_t>(got));
    }
  }

 private:
  pid_t process_ = 0;
  int output_ = -1;
  bool ended_ = false;
  int status_ = 0;
  std::string said_;
};

// The example as users set it up: with the shipped configuration.
class Listener : public Process {
 public:
  Listener()
      : Process({TTF_ROS_LISTEN, std::to_string(kRosDomain)},
                {"CYCLONEDDS_URI=file://" TTF_SOURCE_DIR "/bus/dds/loopback.xml"}) {}

  // The next wanted line; earlier ones are discarded. Empty: it has not come in time.
  std::optional<nlohmann::json> find(const std::function<bool(const nlohmann::json&)>& wanted,
                                     std::chrono::milliseconds patience) {
    const auto until = std::chrono::steady_clock::now() + patience;
    while (true) {
      const auto left = std::chrono::ceil<std::chrono::milliseconds>(until - std::chrono::steady_clock::now());
      const std::optional<std::string> text = line(std::max(left, std::chrono::milliseconds{0}));
      if (!text) return {};
      nlohmann::json json = nlohmann::json::parse(*text);
      if (wanted(json)) return json;
    }
  }
};

inline bool is_event_of(const nlohmann::json& line, const std::string& event, const std::string& topic) {
  return line.at("event") == event && line.at("topic") == topic;
}
inline bool is_sample_of(const nlohmann::json& line, const std::string& topic) {
  return is_event_of(line, "sample", topic);
}

}  // namespace ttf::bus::dds::ros
