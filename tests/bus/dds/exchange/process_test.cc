// The exchange over DDS between processes: they talk, they are stopped, they are killed.
#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <list>
#include <map>
#include <optional>
#include <set>
#include <thread>

#include "bus/dds/exchange/exchange.h"
#include "bus/dds/exchange/exchange_supervisor.h"
#include "tests/bus/dds/common/sessions.h"
#include "tests/bus/dds/exchange/member_processes.h"

namespace ttf::bus::dds::exchange {
namespace {

using namespace std::chrono_literals;
using test::Sizes;
using What = ExchangeSupervisor::What;

// All members of a session as processes, and their supervisor here.
class Launch {
 public:
  Launch(const common::Session& session, Mode mode, std::uint64_t count, Sizes sizes,
         const std::set<std::size_t>& endless = {})
      : session_(session), sizes_(sizes), count_(count) {
    if (session.supervised) supervisor_.emplace(session);
    for (const NodeId node : session.members) members_.emplace_back(session, node, mode, count, sizes, endless);
  }
  void wait_ready() { supervisor_->wait_ready(30s); }
  MemberProcess& member(std::size_t index) { return *std::next(members_.begin(), static_cast<std::ptrdiff_t>(index)); }
  ExchangeSupervisor& supervisor() { return *supervisor_; }
  void kill(std::size_t index) {
    member(index).signal(SIGKILL);
    EXPECT_EQ(member(index).wait(), -SIGKILL);
  }
  // Waits for all members that were not killed. Expects `count` messages of members not in `dead`. Members in
  // `dead` must be gone, and all must have received the same beginning of their messages. Announces every end,
  // as a launch does.
  void expect_all_received(const std::set<std::size_t>& dead = {}) {
    std::map<std::size_t, std::optional<MemberProcess::ReceivedOf>> of_dead;
    for (MemberProcess& member : members_) {
      const std::size_t self = index_of(member.self());
      if (dead.contains(self)) continue;
      ASSERT_EQ(member.wait(), 0) << "node " << self << ": " << member.said();
      if (supervisor_) supervisor_->announce_gone(member.self());
      const auto received = member.received();
      ASSERT_EQ(received.size(), session_.members.size() - 1);
      for (const auto& [from, of] : received) {
        if (!dead.contains(from)) {
          EXPECT_EQ(of.count, count_) << self << " of " << from;
          EXPECT_EQ(of.hash, hash_of_messages(NodeId{static_cast<std::uint8_t>(from)}, count_, sizes_));
          continue;
        }
        EXPECT_TRUE(of.gone) << self << " of " << from;
        auto& first = of_dead[from];
        if (!first) {
          first = of;
          EXPECT_EQ(of.hash, hash_of_messages(NodeId{static_cast<std::uint8_t>(from)}, of.count, sizes_));
        }
        EXPECT_EQ(of, *first) << "heard by " << self << " of " << from << ", " << of.count << " for " << first->count;
      }
    }
    for (const auto& [node, of] : of_dead) last_received_[node] = of->count;
  }
  std::uint64_t last_received(std::size_t dead) const { return last_received_.at(dead); }
  // The next event of this kind about this node; others are passed over.
  std::optional<ExchangeSupervisor::Event> await(What what, std::size_t node) {
    const auto deadline = std::chrono::steady_clock::now() + 20s;
    while (std::chrono::steady_clock::now() < deadline)
      if (const auto event = supervisor_->next_event(100ms))
        if (event->what == what && index_of(event->node) == node) return event;
    return {};
  }

 private:
  common::Session session_;
  Sizes sizes_;
  std::uint64_t count_;
  std::optional<ExchangeSupervisor> supervisor_;
  std::list<MemberProcess> members_;
  std::map<std::size_t, std::uint64_t> last_received_;
};

class DdsProcesses : public testing::TestWithParam<std::size_t> {};
INSTANTIATE_TEST_SUITE_P(Members, DdsProcesses, testing::Values(2, 3, 6));

TEST_P(DdsProcesses, ReceiveEachOtherInRounds) {
  Launch launch(common::session(GetParam()), Mode::kRounds, 400, Sizes::kAll);
  launch.wait_ready();
  launch.expect_all_received();
}

TEST_P(DdsProcesses, ReceiveEachOtherAsFastAsTheyCan) {
  Launch launch(common::session(GetParam()), Mode::kTalk, 600, Sizes::kAll);
  launch.wait_ready();
  launch.expect_all_received();
}

TEST_P(DdsProcesses, ReceiveEachOtherWithoutSupervisor) {
  common::Session session = common::session(GetParam());
  session.supervised = false;
  Launch launch(session, Mode::kRounds, 1200, Sizes::kSmall);
  launch.expect_all_received();
}

TEST(DdsKill, AllSurvivorsReceiveTheSameOfTheDead) {
  for (const auto delay : {0ms, 3ms, 20ms, 100ms, 300ms}) {
    SCOPED_TRACE(delay.count());
    Launch launch(common::session(5), Mode::kTalk, 300, Sizes::kAll, {1});
    launch.wait_ready();
    std::this_thread::sleep_for(delay);
    launch.kill(1);
    launch.supervisor().announce_gone(NodeId{1});
    const auto gone = launch.await(What::kGone, 1);
    ASSERT_TRUE(gone);
    launch.expect_all_received({1});
    EXPECT_EQ(gone->samples, launch.last_received(1) + 1);  // and its hello
  }
}

TEST(DdsKill, TheOthersGoOnInRoundsWithoutTheDead) {
  Launch launch(common::session(4), Mode::kRounds, 4000, Sizes::kSmall, {2});
  launch.wait_ready();
  std::this_thread::sleep_for(50ms);
  launch.kill(2);
  const auto began = std::chrono::steady_clock::now();
  launch.supervisor().announce_gone(NodeId{2});
  ASSERT_TRUE(launch.await(What::kGone, 2));
  EXPECT_LT(std::chrono::steady_clock::now() - began, 5s);  // without waiting for its lease of 10 s
  launch.expect_all_received({2});
}

TEST(DdsKill, TwoAtOnceAndOneWhileItsEndIsAgreedUpon) {
  Launch launch(common::session(6), Mode::kTalk, 200, Sizes::kAll, {0, 3, 5});
  launch.wait_ready();
  std::this_thread::sleep_for(150ms);
  for (const std::size_t victim : {0, 3, 5}) launch.member(victim).signal(SIGKILL);
  for (const std::size_t victim : {3, 0, 5}) {
    launch.kill(victim);
    launch.supervisor().announce_gone(NodeId{static_cast<std::uint8_t>(victim)});
    std::this_thread::sleep_for(5ms);
  }
  launch.expect_all_received({0, 3, 5});
}

TEST(DdsKill, WithoutSupervisorItIsAnErrorThatNamesTheDead) {
  common::Session session = common::session(3);
  session.supervised = false;
  session.lease = 1s;
  Launch launch(session, Mode::kRounds, 1, Sizes::kSmall, {0, 1, 2});
  for (const std::size_t member : {0, 1, 2}) launch.member(member).await_ready();
  launch.kill(1);
  for (const std::size_t survivor : {0, 2}) {
    EXPECT_EQ(launch.member(survivor).wait(), 1);
    EXPECT_EQ(launch.member(survivor).said(), "ready\nerror: exchange: DDS has lost contact with node 1\n");
  }
}

TEST(DdsStop, ForLongerThanTheLeaseChangesNothing) {
  common::Session session = common::session(3);
  session.lease = 1s;
  Launch launch(session, Mode::kRounds, 8000, Sizes::kSmall);
  launch.wait_ready();
  std::this_thread::sleep_for(100ms);
  launch.member(1).signal(SIGSTOP);
  EXPECT_TRUE(launch.await(What::kLost, 1));
  std::this_thread::sleep_for(500ms);
  launch.member(1).signal(SIGCONT);
  EXPECT_TRUE(launch.await(What::kBack, 1));
  launch.expect_all_received();
}

TEST(DdsStop, ShortOnesOfAnybodyChangeNothing) {
  Launch launch(common::session(4), Mode::kRounds, 3000, Sizes::kAll);
  launch.wait_ready();
  std::uint64_t draw = 1;
  for (int i = 0; i < 20; ++i) {
    draw = test::scattered(draw);
    MemberProcess& member = launch.member(draw % 4);
    member.signal(SIGSTOP);
    std::this_thread::sleep_for(std::chrono::milliseconds(draw / 4 % 40));
    member.signal(SIGCONT);
    std::this_thread::sleep_for(std::chrono::milliseconds(draw / 256 % 20));
  }
  launch.expect_all_received();
}

TEST(DdsSessions, TwoAtOnceDoNotMix) {
  Launch one(common::session(3), Mode::kRounds, 1000, Sizes::kAll);
  Launch other(common::session(3), Mode::kTalk, 2000, Sizes::kSmall);
  one.wait_ready();
  other.wait_ready();
  one.expect_all_received();
  other.expect_all_received();
}

TEST(DdsConfiguration, TheShippedFileServes) {
  setenv("CYCLONEDDS_URI", "file://" TTF_SOURCE_DIR "/bus/dds/loopback.xml", 1);
  {
    Launch launch(common::session(3), Mode::kRounds, 100, Sizes::kSmall);
    launch.wait_ready();
    launch.expect_all_received();
  }
  unsetenv("CYCLONEDDS_URI");
}

}  // namespace
}  // namespace ttf::bus::dds::exchange
