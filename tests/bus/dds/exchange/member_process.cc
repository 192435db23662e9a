// A member of an exchange over DDS as a separate process.
//
//   dds_member DOMAIN SESSION SELF MEMBERS LEASE_MS supervised|alone MODE COUNT small|all [ENDLESS...]
//
//   MODE     talk: sends COUNT messages as fast as it can, then receives the others
//            rounds: COUNT times, sends one, then receives one of each other member that is still there
//   ENDLESS  nodes that do not stop at COUNT
//
// Prints "ready" once all members receive each other. Ends when every other member has sent COUNT messages, or
// is gone if it is endless. Prints one line for each other member: its number, the count of its messages,
// their hash, and whether it went. If the exchange fails, prints "error: ..." and exits with 1.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <exception>
#include <map>
#include <set>
#include <stdexcept>
#include <string>

#include "bus/dds/exchange/exchange.h"
#include "tests/support/messages.h"

namespace ttf::bus::dds::exchange {
namespace {

constexpr std::uint64_t kEndless = ~std::uint64_t{0};

struct ReceivedOf {
  std::uint64_t expected = 0;
  std::uint64_t count = 0;
  std::uint64_t hash = test::kHashBegin;
  bool gone = false;
};

class TalkingMember {
 public:
  TalkingMember(const common::Session& session, NodeId self, std::uint64_t count, test::Sizes sizes,
                const std::set<NodeId>& endless)
      : exchange_(session, self), self_(self), count_(endless.contains(self) ? kEndless : count), sizes_(sizes) {
    for (const NodeId node : session.members)
      if (node != self) others_[node].expected = endless.contains(node) ? kEndless : count;
    exchange_.wait_ready(std::chrono::seconds(30));
    fmt::print("ready\n");
    std::fflush(stdout);
  }
  void talk() {
    while (said_ < count_) say();
    receive_all(kEndless);
  }
  void rounds() {
    while (said_ < count_) {
      say();
      receive_all(said_);
    }
    receive_all(kEndless);
  }
  void report() const {
    for (const auto& [node, received] : others_)
      fmt::print("{} {} {:016x} {}\n", index_of(node), received.count, received.hash, received.gone ? "gone" : "there");
  }

 private:
  void say() { exchange_.send(test::message(self_, said_++, sizes_)); }
  // Up to message `round` of each.
  void receive_all(std::uint64_t round) {
    for (const auto& [node, other] : others_)
      while (other.count < std::min(round, other.expected) && !other.gone) receive();
  }
  void receive() {
    const auto received = exchange_.receive();
    ReceivedOf& of = others_.at(received.from);
    if (of.gone) throw std::runtime_error("heard of one who had gone");
    of.gone = received.gone;
    if (received.gone) return;
    ++of.count;
    of.hash = test::hash_of(received.bytes, of.hash);
  }

  Exchange exchange_;
  NodeId self_;
  std::uint64_t count_;
  test::Sizes sizes_;
  std::uint64_t said_ = 0;
  std::map<NodeId, ReceivedOf> others_;
};

int run(int words, char** arguments) {
  common::Session session;
  session.domain = static_cast<std::uint32_t>(std::stoul(arguments[1]));
  session.name = arguments[2];
  const NodeId self{static_cast<std::uint8_t>(std::stoul(arguments[3]))};
  for (std::size_t i = 0; i < std::stoul(arguments[4]); ++i)
    session.members.push_back(NodeId{static_cast<std::uint8_t>(i)});
  session.lease = std::chrono::milliseconds(std::stol(arguments[5]));
  session.supervised = std::string(arguments[6]) == "supervised";
  std::set<NodeId> endless;
  for (int i = 10; i < words; ++i) endless.insert(NodeId{static_cast<std::uint8_t>(std::stoul(arguments[i]))});
  TalkingMember member(session, self, std::stoull(arguments[8]),
                       std::string(arguments[9]) == "all" ? test::Sizes::kAll : test::Sizes::kSmall, endless);
  if (std::string(arguments[7]) == "talk")
    member.talk();
  else
    member.rounds();
  member.report();
  return 0;
}

}  // namespace
}  // namespace ttf::bus::dds::exchange

int main(int words, char** arguments) {
  if (words < 10) return 2;
  try {
    return ttf::bus::dds::exchange::run(words, arguments);
  } catch (const std::exception& error) {
    fmt::print("error: {}\n", error.what());
    return 1;
  }
}
