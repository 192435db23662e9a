// The real-time medium over DDS between processes. Some are stopped, killed and restarted; the others are
// unaffected.
#include <gtest/gtest.h>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <set>
#include <sstream>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "bus/dds/live/medium.h"
#include "tests/bus/dds/common/sessions.h"
#include "tests/bus/dds/live/live_lines.h"
#include "tests/support/child_process.h"

namespace ttf::bus::dds::live {
namespace {

using namespace std::chrono_literals;

struct LiveReport {
  std::uint64_t lost = 0, longest_us = 0;
  std::string wrong;
  std::vector<std::uint64_t> received;  // by member, on both channels
};

LiveReport report_of(const test::ChildProcess& child, std::size_t members) {
  LiveReport report;
  std::string word;
  std::istringstream lines(child.said_after_ready());
  lines >> word >> report.lost >> word >> report.longest_us >> word;
  std::getline(lines, report.wrong);
  report.received.resize(members);
  for (std::size_t node = 0; lines >> node && node < members;) lines >> report.received[node];
  return report;
}

// Members of a session as processes, some of which will be spoilt.
class LiveProcesses {
 public:
  LiveProcesses(const common::Session& session, std::size_t count, std::set<std::size_t> spoilt = {},
                const std::string& delivery = "best-effort")
      : session_(session), count_(count), spoilt_(std::move(spoilt)), delivery_(delivery) {
    for (std::size_t i = 0; i < session.members.size(); ++i) members_.push_back(start(i));
    for (auto& member : members_) member->await_ready();
    for (auto& member : members_) member->report("begin");
  }
  test::ChildProcess& member(std::size_t index) { return *members_[index]; }
  void start_anew(std::size_t index) {
    members_[index] = start(index);
    members_[index]->await_ready();
    members_[index]->report("begin");
  }
  LiveReport end(std::size_t spoilt) {
    members_[spoilt]->report("end");
    EXPECT_EQ(members_[spoilt]->wait(), 0) << members_[spoilt]->said();
    return report_of(*members_[spoilt], members_.size());
  }
  // All others have received each other's messages completely, without waiting. There are no losses, or only of
  // spoilt members' messages.
  enum class Lost { kNothing, kButOfSpoilt };
  std::vector<LiveReport> expect_undisturbed(Lost lost = Lost::kNothing) {
    std::vector<LiveReport> reports(members_.size());
    for (std::size_t i = 0; i < members_.size(); ++i) {
      if (spoilt_.contains(i)) continue;
      EXPECT_EQ(members_[i]->wait(), 0) << "member " << i << ": " << members_[i]->said();
      reports[i] = report_of(*members_[i], members_.size());
      EXPECT_EQ(reports[i].wrong, " -") << i;
      if (lost == Lost::kNothing) {
        EXPECT_EQ(reports[i].lost, 0u) << i;
      }
      EXPECT_LT(reports[i].longest_us, 500'000u) << i;
      for (std::size_t other = 0; other < members_.size(); ++other) {
        if (other == i || spoilt_.contains(other)) continue;
        EXPECT_EQ(reports[i].received[other], 2 * count_) << i << " of " << other;
      }
    }
    return reports;
  }

 private:
  std::unique_ptr<test::ChildProcess> start(std::size_t self) const {
    std::vector<std::string> words{TTF_DDS_LIVE_MEMBER,
                                   std::to_string(session_.domain),
                                   session_.name,
                                   std::to_string(self),
                                   std::to_string(session_.members.size()),
                                   std::to_string(session_.lease.count()),
                                   delivery_,
                                   std::to_string(count_)};
    for (const std::size_t node : spoilt_) words.push_back(std::to_string(node));
    return std::make_unique<test::ChildProcess>(words);
  }

  common::Session session_;
  std::size_t count_;
  std::set<std::size_t> spoilt_;
  std::string delivery_;
  std::vector<std::unique_ptr<test::ChildProcess>> members_;
};

class DdsLiveProcesses : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Delivery, DdsLiveProcesses, testing::Values("best-effort", "reliable"),
                         [](const auto& instance) { return instance.param[0] == 'r' ? "Reliable" : "BestEffort"; });

TEST_P(DdsLiveProcesses, ReceiveEachOther) {
  LiveProcesses processes(common::session(4), 2000, {}, GetParam());
  processes.expect_undisturbed();
}

TEST_P(DdsLiveProcesses, DoNotNoticeThatOneIsKilledAndReceiveItStartedAnew) {
  LiveProcesses processes(common::session(4), 4000, {2}, GetParam());
  std::this_thread::sleep_for(700ms);
  processes.member(2).signal(SIGKILL);
  EXPECT_EQ(processes.member(2).wait(), -SIGKILL);
  std::this_thread::sleep_for(300ms);
  processes.start_anew(2);
  std::this_thread::sleep_for(1s);
  const LiveReport anew = processes.end(2);
  EXPECT_EQ(anew.lost, 0u);
  for (const std::size_t i : {0, 1, 3}) EXPECT_GT(anew.received[i], 500u) << i;
  const auto reports = processes.expect_undisturbed();  // a new beginning is no gap
  for (const std::size_t i : {0, 1, 3}) EXPECT_GT(reports[i].received[2], 2 * 1000u) << i;
}

// Stopped within its lease: it counts its losses.
TEST_P(DdsLiveProcesses, DoNotNoticeThatOneIsStopped) {
  LiveProcesses processes(common::session(4), 4500, {1}, GetParam());
  std::this_thread::sleep_for(300ms);
  processes.member(1).signal(SIGSTOP);
  std::this_thread::sleep_for(3s);
  processes.member(1).signal(SIGCONT);
  processes.expect_undisturbed();
  std::this_thread::sleep_for(300ms);
  const LiveReport stopped = processes.end(1);
  EXPECT_EQ(stopped.received[0] + stopped.received[2] + stopped.received[3] + stopped.lost, 3 * 2 * 4500u);
}

// Stopped for longer than its lease: it is found again. Its messages until then reach no member, and are
// counted.
TEST_P(DdsLiveProcesses, ReceiveANodeStoppedForLongerThanItsLease) {
  common::Session session = common::session(3);
  session.lease = 1s;
  LiveProcesses processes(session, 12'000, {1}, GetParam());
  std::this_thread::sleep_for(300ms);
  processes.member(1).signal(SIGSTOP);
  std::this_thread::sleep_for(3s);
  processes.member(1).signal(SIGCONT);
  const auto reports = processes.expect_undisturbed(LiveProcesses::Lost::kButOfSpoilt);
  const LiveReport stopped = processes.end(1);
  for (const std::size_t i : {0, 2}) {
    EXPECT_GT(stopped.received[i], 2 * 2000u) << i;
    EXPECT_GT(reports[i].received[1], 2 * 2000u) << i;
  }
}

TEST(DdsLiveReadiness, NamesWhoIsMissing) {
  const common::Session session = common::session(3);
  const auto plans = live_lines(3);
  const DdsMedium here(session, NodeId{0}, lines_of(plans, NodeId{0}));
  const DdsMedium other(session, NodeId{2}, lines_of(plans, NodeId{2}));
  try {
    here.wait_ready(200ms);
    FAIL() << "is ready without node 1";
  } catch (const common::NotReady& error) {
    EXPECT_EQ(error.absent(), std::vector{NodeId{1}});
    EXPECT_EQ(error.deaf(), std::vector{NodeId{1}});
  }
}

}  // namespace
}  // namespace ttf::bus::dds::live
