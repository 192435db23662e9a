// A program that tests start, stop and kill. It prints a line "ready", and its results before it ends.
#pragma once

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "core/check.h"

namespace ttf::test {

class ChildProcess {
 public:
  // `words`: the program and its arguments.
  explicit ChildProcess(std::vector<std::string> words) {
    int in[2], out[2];
    TTF_CHECK(pipe2(in, O_CLOEXEC) == 0 && pipe2(out, O_CLOEXEC) == 0);
    input_ = in[1];
    output_ = out[0];
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, in[0], STDIN_FILENO);
    posix_spawn_file_actions_adddup2(&actions, out[1], STDOUT_FILENO);
    TTF_CHECK(posix_spawn(&process_, arguments[0], &actions, nullptr, arguments.data(), environ) == 0);
    posix_spawn_file_actions_destroy(&actions);
    close(in[0]);
    close(out[1]);
  }
  ~ChildProcess() {
    if (!ended_) {
      signal(SIGKILL);
      wait();
    }
    close(input_);
    close(output_);
  }
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  void signal(int number) const { kill(process_, number); }
  // Writes a line to its input.
  void report(const std::string& line) const {
    const std::string text = line + '\n';
    TTF_CHECK(write(input_, text.data(), text.size()) == static_cast<ssize_t>(text.size()));
  }
  // Returns once it is ready, or has ended.
  void await_ready() {
    for (char letter = 0; letter != '\n' && read(output_, &letter, 1) == 1;) said_ += letter;
  }
  // Its exit code, or minus the signal that ended it.
  int wait() {
    if (std::exchange(ended_, true)) return status_;
    char buffer[4096];
    for (ssize_t got; (got = read(output_, buffer, sizeof buffer)) > 0;)
      said_.append(buffer, static_cast<std::size_t>(got));
    int status = 0;
    TTF_CHECK(waitpid(process_, &status, 0) == process_);
    return status_ = WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  }
  // After wait(), all of it.
  static inline const std::string kReady = "ready\n";
  const std::string& said() const { return said_; }
  std::string said_after_ready() const { return said_.substr(std::min(said_.size(), kReady.size())); }

 private:
  pid_t process_ = 0;
  int input_ = -1, output_ = -1;
  bool ended_ = false;
  int status_ = 0;
  std::string said_;
};

}  // namespace ttf::test
