// The cost of the exchange over DDS: round trips between two processes and between two threads, and rounds of
// six processes. In a round each process sends one message and receives one of each other. A pipe's round trip
// between two processes in the same run gives the cost of the machine's scheduler, which passes the turn on
// twice.
#include <benchmark/benchmark.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstdint>
#include <exception>
#include <map>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "bus/dds/exchange/exchange.h"
#include "bus/dds/exchange/exchange_supervisor.h"
#include "core/check.h"
#include "tests/bench/yardstick.h"

namespace ttf::bench {
namespace {

using namespace std::chrono_literals;

constexpr std::size_t kBytes = 100;
constexpr std::uint32_t kDomain = 18;  // used by no other test
using Message = std::array<std::byte, kBytes>;

bus::dds::common::Session session_of(const std::string& name, std::size_t members) {
  bus::dds::common::Session session;
  session.domain = kDomain;
  session.name = name;
  for (std::size_t i = 0; i < members; ++i) session.members.push_back(NodeId{static_cast<std::uint8_t>(i)});
  return session;
}

// One round: sends a message, and receives one of each other. Returns false when a member has gone.
class RoundMember {
 public:
  RoundMember(const bus::dds::common::Session& session, NodeId self)
      : exchange_(session, self), others_(session.members.size() - 1) {
    exchange_.wait_ready(30s);
  }
  bool round() {
    exchange_.send(message_);
    return receive();
  }
  // Answers: receives first.
  bool round_in_turn() {
    if (!receive()) return false;
    exchange_.send(message_);
    return true;
  }

 private:
  // A member is ahead by at most one message.
  bool receive() {
    ++round_;
    for (std::size_t left = others_ - ahead_, ahead = 0;;) {
      if (left == 0) {
        ahead_ = ahead;
        return true;
      }
      const auto received = exchange_.receive();
      if (received.gone) return false;
      if (++count_[received.from] > round_)
        ++ahead;
      else
        --left;
    }
  }

  bus::dds::exchange::Exchange exchange_;
  std::size_t others_;
  std::size_t ahead_ = 0;  // the member whose message of the next round has been received
  std::uint64_t round_ = 0;
  std::map<NodeId, std::uint64_t> count_;
  Message message_{};
};

// This program again, as a member that does rounds until somebody goes.
int be_member(char** arguments) {
  const bus::dds::common::Session session = session_of(arguments[2], std::stoul(arguments[4]));
  RoundMember member(session, NodeId{static_cast<std::uint8_t>(std::stoul(arguments[3]))});
  if (session.members.size() == 2) {
    while (member.round_in_turn()) {
    }
  } else {
    while (member.round()) {
    }
  }
  return 0;
}

pid_t start_member(const bus::dds::common::Session& session, std::size_t self) {
  std::vector<std::string> words{"/proc/self/exe", "--member", session.name, std::to_string(self),
                                 std::to_string(session.members.size())};
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  pid_t process = 0;
  TTF_CHECK(posix_spawn(&process, arguments[0], nullptr, nullptr, arguments.data(), environ) == 0);
  return process;
}

// Rounds with the others in separate processes; two members pass a message to and fro.
void DdsRounds(benchmark::State& state) {
  static int made = 0;
  const auto members = static_cast<std::size_t>(state.range(0));
  const bus::dds::common::Session session =
      session_of("bench-" + std::to_string(getpid()) + "-" + std::to_string(made++), members);
  std::vector<pid_t> processes;
  for (std::size_t i = 1; i < members; ++i) processes.push_back(start_member(session, i));
  {
    bus::dds::exchange::ExchangeSupervisor supervisor(session);
    std::optional<RoundMember> self(std::in_place, session, NodeId{0});
    for (auto _ : state)
      if (!self->round()) return state.SkipWithError("somebody has gone");
    self.reset();
    for (const pid_t process : processes) waitpid(process, nullptr, 0);
  }
  state.SetItemsProcessed(state.iterations() * state.range(0));  // messages
}
BENCHMARK(DdsRounds)->ArgName("processes")->Arg(2)->Arg(6)->UseRealTime()->Unit(benchmark::kMicrosecond);

void DdsThereAndBackBetweenThreads(benchmark::State& state) {
  static int made = 0;
  const bus::dds::common::Session session =
      session_of("bench-t-" + std::to_string(getpid()) + "-" + std::to_string(made++), 2);
  bus::dds::exchange::ExchangeSupervisor supervisor(session);
  std::thread other([&session] {
    RoundMember member(session, NodeId{1});
    while (member.round_in_turn()) {
    }
  });
  {
    RoundMember self(session, NodeId{0});
    for (auto _ : state)
      if (!self.round()) state.SkipWithError("the other has gone");
  }
  other.join();
}
BENCHMARK(DdsThereAndBackBetweenThreads)->UseRealTime()->Unit(benchmark::kMicrosecond);

void PipeThereAndBack(benchmark::State& state) {
  int there[2], back[2];
  TTF_CHECK(pipe(there) == 0 && pipe(back) == 0);
  Message message{};
  const pid_t child = fork();
  TTF_CHECK(child >= 0);
  if (child == 0) {  // only calls that may follow a fork
    close(there[1]);
    while (read(there[0], message.data(), kBytes) == static_cast<ssize_t>(kBytes))
      if (write(back[1], message.data(), kBytes) < 0) break;
    _exit(0);
  }
  close(there[0]);
  for (auto _ : state) {
    const bool passed = write(there[1], message.data(), kBytes) == static_cast<ssize_t>(kBytes) &&
                        read(back[0], message.data(), kBytes) == static_cast<ssize_t>(kBytes);
    if (!passed) return state.SkipWithError("the pipe is broken");
  }
  close(there[1]);
  waitpid(child, nullptr, 0);
  close(back[0]);
  close(back[1]);
}
BENCHMARK(PipeThereAndBack)->UseRealTime()->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace ttf::bench

int main(int count, char** arguments) {
  if (count == 5 && std::string(arguments[1]) == "--member") {
    try {
      return ttf::bench::be_member(arguments);
    } catch (const std::exception&) {
      return 1;  // the measuring process notices its end
    }
  }
  benchmark::Initialize(&count, arguments);
  if (benchmark::ReportUnrecognizedArguments(count, arguments)) return 2;
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
