// Members of an exchange as processes (member_process.cc), and what they say in the end.
#pragma once

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "bus/dds/session.h"
#include "core/check.h"
#include "core/ids.h"
#include "tests/support/messages.h"

namespace ttf::test {

enum class Mode { kTalk, kRounds };

class MemberProcess {
 public:
  struct HeardOf {
    std::uint64_t count = 0;
    std::string hash;
    bool gone = false;
    bool operator==(const HeardOf&) const = default;
  };

  MemberProcess(const dds::Session& session, NodeId self, Mode mode, std::uint64_t count, Sizes sizes,
                const std::set<std::size_t>& endless)
      : self_(self) {
    int ends[2];
    TTF_CHECK(pipe2(ends, O_CLOEXEC) == 0);
    output_ = ends[0];
    std::vector<std::string> words{TTF_DDS_MEMBER,
                                   std::to_string(session.domain),
                                   session.name,
                                   std::to_string(index_of(self)),
                                   std::to_string(session.members.size()),
                                   std::to_string(session.lease.count()),
                                   session.supervised ? "supervised" : "alone",
                                   mode == Mode::kTalk ? "talk" : "rounds",
                                   std::to_string(count),
                                   sizes == Sizes::kAll ? "all" : "small"};
    for (const std::size_t node : endless) words.push_back(std::to_string(node));
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
    TTF_CHECK(posix_spawn(&process_, TTF_DDS_MEMBER, &actions, nullptr, arguments.data(), environ) == 0);
    posix_spawn_file_actions_destroy(&actions);
    close(ends[1]);
  }
  ~MemberProcess() {
    if (!ended_) {
      signal(SIGKILL);
      wait();
    }
    close(output_);
  }
  MemberProcess(const MemberProcess&) = delete;
  MemberProcess& operator=(const MemberProcess&) = delete;

  NodeId self() const { return self_; }
  void signal(int number) const { kill(process_, number); }
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
  // After wait(). It begins with kReady.
  static inline const std::string kReady = "ready\n";
  const std::string& said() const { return said_; }
  std::map<std::size_t, HeardOf> heard() const {
    std::map<std::size_t, HeardOf> heard;
    std::istringstream lines(said_.substr(std::min(said_.size(), kReady.size())));
    std::size_t node = 0;
    HeardOf of;
    for (std::string how; lines >> node >> of.count >> of.hash >> how; heard[node] = of) of.gone = how == "gone";
    return heard;
  }

 private:
  NodeId self_;
  pid_t process_ = 0;
  int output_ = -1;
  bool ended_ = false;
  int status_ = 0;
  std::string said_;
};

// What is heard of a node that says `count` messages.
inline std::string hash_of_messages(NodeId node, std::uint64_t count, Sizes sizes) {
  std::uint64_t hash = kHashBegin;
  for (std::uint64_t i = 0; i < count; ++i) hash = hash_of(message(node, i, sizes), hash);
  return fmt::format("{:016x}", hash);
}

}  // namespace ttf::test
