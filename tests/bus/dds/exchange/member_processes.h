// Members of an exchange as processes (member_process.cc), and their final reports.
#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "bus/dds/common/session.h"
#include "core/ids.h"
#include "tests/support/child_process.h"
#include "tests/support/messages.h"

namespace ttf::bus::dds::exchange {

enum class Mode { kTalk, kRounds };

class MemberProcess : public test::ChildProcess {
 public:
  struct ReceivedOf {
    std::uint64_t count = 0;
    std::string hash;
    bool gone = false;
    bool operator==(const ReceivedOf&) const = default;
  };

  MemberProcess(const common::Session& session, NodeId self, Mode mode, std::uint64_t count, test::Sizes sizes,
                const std::set<std::size_t>& endless)
      : test::ChildProcess(words(session, self, mode, count, sizes, endless)), self_(self) {}

  NodeId self() const { return self_; }
  // After wait().
  std::map<std::size_t, ReceivedOf> received() const {
    std::map<std::size_t, ReceivedOf> received;
    std::istringstream lines(said_after_ready());
    std::size_t node = 0;
    ReceivedOf of;
    for (std::string how; lines >> node >> of.count >> of.hash >> how; received[node] = of) of.gone = how == "gone";
    return received;
  }

 private:
  static std::vector<std::string> words(const common::Session& session, NodeId self, Mode mode, std::uint64_t count,
                                        test::Sizes sizes, const std::set<std::size_t>& endless) {
    std::vector<std::string> all{TTF_DDS_MEMBER,
                                 std::to_string(session.domain),
                                 session.name,
                                 std::to_string(index_of(self)),
                                 std::to_string(session.members.size()),
                                 std::to_string(session.lease.count()),
                                 session.supervised ? "supervised" : "alone",
                                 mode == Mode::kTalk ? "talk" : "rounds",
                                 std::to_string(count),
                                 sizes == test::Sizes::kAll ? "all" : "small"};
    for (const std::size_t node : endless) all.push_back(std::to_string(node));
    return all;
  }

  NodeId self_;
};

// The hash of the messages from a node that sends `count` of them.
inline std::string hash_of_messages(NodeId node, std::uint64_t count, test::Sizes sizes) {
  std::uint64_t hash = test::kHashBegin;
  for (std::uint64_t i = 0; i < count; ++i) hash = test::hash_of(message(node, i, sizes), hash);
  return fmt::format("{:016x}", hash);
}

}  // namespace ttf::bus::dds::exchange
