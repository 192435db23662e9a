// A member of a real-time medium over DDS as a separate process.
//
//   dds_live_member DOMAIN SESSION SELF MEMBERS LEASE_MS best-effort|reliable COUNT [SPOILT...]
//
//   COUNT    its number of messages on either channel, one a millisecond on each
//   SPOILT   members that are killed, stopped or restarted: their messages are counted, not checked. Messages of the
//            others must be complete. A member that is itself spoilt sends endlessly, and may miss some.
//
// Prints "ready" once it receives all others and they receive it, and begins at the first line on stdin. Ends when
// it has sent and received all messages; a spoilt member ends at the second line. Then prints "lost N longest_us
// N wrong TEXT", with the longest send(), and one line for each other member: "NODE HEARD".
#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "bus/dds/live/medium.h"
#include "tests/bus/dds/live/live_lines.h"
#include "tests/laws/live_traffic.h"

namespace ttf::bus::dds::live {
namespace {

using namespace std::chrono_literals;

class LiveMember {
 public:
  LiveMember(const common::Session& session, NodeId self, Delivery delivery, std::size_t count,
             const std::set<std::size_t>& spoilt)
      : medium_(session, self, lines_of(live_lines(session.members.size()), self), delivery), self_(index_of(self)),
        members_(session.members.size()), count_(count), spoilt_(spoilt), received_(members_) {
    medium_.wait_ready(30s);
    fmt::print("ready\n");
    std::fflush(stdout);
  }
  void work() {
    commanded(-1);
    const bool endless = spoilt_.contains(self_);
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::milliseconds(count_) + 30s;
    auto next = std::chrono::steady_clock::now();
    while (wrong_.empty() && !(endless ? commanded(0) : said_ == count_ && received_all())) {
      if (std::chrono::steady_clock::now() > deadline) wrong_ = "waits in vain";
      if ((endless || said_ < count_) && std::chrono::steady_clock::now() >= next) {
        say();
        next = std::max(next + 1ms, std::chrono::steady_clock::now() - 100ms);
      }
      while (const auto arrival = medium_.receive()) receive(*arrival);
      std::this_thread::sleep_for(200us);
    }
    if (!medium_.failure().empty()) wrong_ = medium_.failure();
  }
  void report() const {
    fmt::print("lost {} longest_us {} wrong {}\n", medium_.counts().lost,
               std::chrono::duration_cast<std::chrono::microseconds>(longest_).count(), wrong_.empty() ? "-" : wrong_);
    for (std::size_t i = 0; i < members_; ++i)
      if (i != self_) fmt::print("{} {}\n", i, received_[i][0] + received_[i][1]);
  }
  bool well() const { return wrong_.empty(); }

 private:
  // Returns whether stdin has a line or has ended; waits up to `patience` ms, -1: for ever.
  static bool commanded(int patience) {
    pollfd input{STDIN_FILENO, POLLIN, 0};
    char letter = 0;
    if (poll(&input, 1, patience) != 1) return false;
    while (read(STDIN_FILENO, &letter, 1) == 1 && letter != '\n') {
    }
    return true;
  }
  void say() {
    for (const ports::Line line : {0, 1}) {
      const laws::Utterance utterance(line, {self_, members_}, said_, laws::Traffic::kAll);
      const auto begin = std::chrono::steady_clock::now();
      if (utterance.send(medium_) != ports::LiveStatus::kDone) wrong_ = "has no room";
      longest_ = std::max(longest_, std::chrono::steady_clock::now() - begin);
    }
    ++said_;
  }
  void receive(const ports::LiveArrival& arrival) {
    const std::size_t from = laws::speaker_of(arrival, members_);
    const ports::Line line = laws::line_of(arrival);
    if (from >= members_ || from == self_ || line > 1) {
      wrong_ = fmt::format("hears {} on line {}", from, line);
      return;
    }
    const std::size_t number = received_[from][line]++;
    if (spoilt_.contains(from) || spoilt_.contains(self_)) return;
    if (!laws::Utterance(line, {from, members_}, number, laws::Traffic::kAll).is(arrival))
      wrong_ = fmt::format("line {}: what is heard of {} is not its number {}", line, from, number);
  }
  bool received_all() const {
    for (std::size_t i = 0; i < members_; ++i)
      if (i != self_ && !spoilt_.contains(i) && (received_[i][0] < count_ || received_[i][1] < count_)) return false;
    return true;
  }

  DdsMedium medium_;
  std::size_t self_, members_, count_;
  std::set<std::size_t> spoilt_;
  std::size_t said_ = 0;
  std::vector<std::array<std::size_t, 2>> received_;  // by member and channel
  std::chrono::steady_clock::duration longest_{};
  std::string wrong_;
};

int run(int words, char** arguments) {
  common::Session session;
  session.domain = static_cast<std::uint32_t>(std::stoul(arguments[1]));
  session.name = arguments[2];
  for (std::size_t i = 0; i < std::stoul(arguments[4]); ++i)
    session.members.push_back(NodeId{static_cast<std::uint8_t>(i)});
  session.lease = std::chrono::milliseconds(std::stol(arguments[5]));
  const auto delivery = std::string(arguments[6]) == "reliable" ? Delivery::kReliable : Delivery::kBestEffort;
  std::set<std::size_t> spoilt;
  for (int i = 8; i < words; ++i) spoilt.insert(std::stoul(arguments[i]));
  LiveMember member(session, NodeId{static_cast<std::uint8_t>(std::stoul(arguments[3]))}, delivery,
                    std::stoul(arguments[7]), spoilt);
  member.work();
  member.report();
  return member.well() ? 0 : 1;
}

}  // namespace
}  // namespace ttf::bus::dds::live

int main(int words, char** arguments) {
  if (words < 8) return 2;
  try {
    return ttf::bus::dds::live::run(words, arguments);
  } catch (const std::exception& error) {
    fmt::print("error: {}\n", error.what());
    return 1;
  }
}
