// Sessions: their requirements, missing and duplicate members, and the configuration of DDS.
#include "bus/dds/common/session.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <fstream>
#include <functional>
#include <iterator>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "bus/dds/common/configuration.h"
#include "bus/dds/exchange/exchange.h"
#include "bus/dds/exchange/exchange_supervisor.h"
#include "core/errors.h"
#include "tests/bus/dds/common/sessions.h"
#include "tests/support/refusals.h"

namespace ttf::bus::dds::common {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;
using testing::IsEmpty;

std::string called(const Session& session) { return "session " + session.name + " on DDS domain 17: "; }

std::string complaint(const Session& session) {
  return support::refusal_of([&] { validate(session); });
}

TEST(DdsSession, IsCheckedBeforeAnythingStarts) {
  EXPECT_EQ(complaint(common::session(64)), "");
  Session session = common::session(2);
  session.domain = 232;
  EXPECT_EQ(complaint(session), "DDS: domain = 232: must be 0..231");
  session = common::session(2);
  for (const std::string& name : std::vector<std::string>{"", "a b", "*", std::string(65, 'x'), "\xc3\xa9"}) {
    session.name = name;
    EXPECT_THAT(complaint(session), testing::EndsWith("must be 1 to 64 letters, digits, '_', '-' or '.'")) << name;
  }
  session = common::session(2);
  session.members = {NodeId{1}, NodeId{1}};
  EXPECT_EQ(complaint(session), "DDS: members = node 1, node 1: must be one or more nodes, each once");
  session.members = {};
  EXPECT_NE(complaint(session), "");
  session = common::session(2);
  session.lease = 99ms;
  EXPECT_EQ(complaint(session), "DDS: lease = 99: must be 100..3600000 ms");
}

TEST(DdsSession, AMissingNodeIsNamedAfterThePatience) {
  const Session session = common::session(3);
  exchange::ExchangeSupervisor supervisor(session);
  exchange::Exchange zero(session, NodeId{0}), two(session, NodeId{2});
  try {
    zero.wait_ready(300ms);
    ADD_FAILURE() << "is ready";
  } catch (const NotReady& error) {
    EXPECT_THAT(error.absent(), ElementsAre(NodeId{1}));
    EXPECT_THAT(error.deaf(), IsEmpty());
    EXPECT_EQ(error.what(), called(session) + "not ready after 0.3 s; not heard: node 1");
  }
  try {
    supervisor.wait_ready(10ms);
    ADD_FAILURE() << "is ready";
  } catch (const NotReady& error) {
    EXPECT_THAT(error.absent(), ElementsAre(NodeId{1}));
  }
}

TEST(DdsSession, ANodeThatDoesNotReceiveTheOthersYetIsNamed) {
  const Session session = common::session(2);
  exchange::ExchangeSupervisor supervisor(session);
  exchange::Exchange zero(session, NodeId{0}), one(session, NodeId{1});  // one is there, but takes no notice
  try {
    zero.wait_ready(500ms);
    ADD_FAILURE() << "is ready";
  } catch (const NotReady& error) {
    EXPECT_THAT(error.absent(), IsEmpty());
    EXPECT_THAT(error.deaf(), ElementsAre(NodeId{1}));
    EXPECT_THAT(error.what(), testing::HasSubstr("not hearing all others: node 1"));
  }
}

TEST(DdsSession, AMissingSupervisorIsNamed) {
  const Session session = common::session(1);
  exchange::Exchange alone(session, NodeId{0});
  try {
    alone.wait_ready(100ms);
    ADD_FAILURE() << "is ready";
  } catch (const NotReady& error) {
    EXPECT_THAT(error.absent(), ElementsAre(kNoNode));
    EXPECT_THAT(error.what(), testing::HasSubstr("not heard: the supervisor"));
  }
}

TEST(DdsSession, ANodeThatDiesBeforeItComesIsNotWaitedFor) {
  const Session session = common::session(3);
  exchange::ExchangeSupervisor supervisor(session);
  exchange::Exchange zero(session, NodeId{0}), one(session, NodeId{1});
  supervisor.announce_gone(NodeId{2});  // it never came
  std::thread thread([&] { one.wait_ready(10s); });
  zero.wait_ready(10s);
  thread.join();
  supervisor.wait_ready(10s);
  const auto received = zero.receive();
  EXPECT_TRUE(received.gone);
  EXPECT_EQ(received.from, NodeId{2});
}

std::string error_of(const std::function<void()>& work) {
  try {
    work();
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "none";
}

TEST(DdsSession, ANodeThatIsThereTwiceIsAnError) {
  Session session = common::session(2);
  session.supervised = false;
  exchange::Exchange one(session, NodeId{1}), again(session, NodeId{1});
  EXPECT_EQ(error_of([&] { one.wait_ready(10s); }), called(session) + "node 1 is there twice");
}

TEST(DdsSession, AStrangerIsAnError) {
  Session session = common::session(2), larger = session;
  larger.members.push_back(NodeId{9});
  session.supervised = larger.supervised = false;
  exchange::Exchange one(session, NodeId{1}), stranger(larger, NodeId{9});
  EXPECT_EQ(error_of([&] { one.wait_ready(10s); }), called(session) + "node 9 is not a member");
}

// Two members and their supervisor, ready.
class DdsPair : public testing::Test {
 protected:
  DdsPair() {
    std::thread thread([this] { one_->wait_ready(10s); });
    zero_->wait_ready(10s);
    thread.join();
  }
  const Session session_ = common::session(2);
  std::optional<exchange::ExchangeSupervisor> supervisor_{session_};
  std::optional<exchange::Exchange> zero_{std::in_place, session_, NodeId{0}}, one_{std::in_place, session_, NodeId{1}};
};

TEST_F(DdsPair, ALivingNodeAnnouncedGoneReceivesThat) {
  supervisor_->announce_gone(NodeId{1});
  EXPECT_TRUE(zero_->receive().gone);
  EXPECT_EQ(error_of([this] { one_->receive(); }), "exchange: node 1 has been removed by the supervisor");
  one_->send({});  // to no member
  EXPECT_EQ(error_of([this] { zero_->receive(); }), "exchange: node 0: all other members are gone");
}

TEST_F(DdsPair, StopsWhenTheSupervisorLeaves) {
  supervisor_.reset();
  EXPECT_EQ(error_of([this] { zero_->receive(); }), "exchange: the supervisor has left");
}

TEST_F(DdsPair, TheSupervisorReportsJoinedAndLeftMembers) {
  zero_.reset();
  supervisor_->announce_gone(NodeId{0});  // a launch does this for every end
  EXPECT_TRUE(one_->receive().gone);
  one_.reset();  // else it would be asked for its messages and not answer
  using Happening = exchange::ExchangeSupervisor::What;
  std::vector<Happening> of_zero;
  while (of_zero.empty() || of_zero.back() != Happening::kGone) {
    const auto event = supervisor_->next_event(5s);
    ASSERT_TRUE(event);
    if (event->node == NodeId{0}) of_zero.push_back(event->what);
  }
  EXPECT_THAT(of_zero, ElementsAre(Happening::kJoined, Happening::kReady, Happening::kLeft, Happening::kGone));
}

TEST(DdsConfiguration, TheShippedFileIsTheBuiltInOne) {
  std::ifstream file(TTF_SOURCE_DIR "/bus/dds/loopback.xml");
  const std::string text((std::istreambuf_iterator<char>(file)), {});
  const auto begin = text.find("<CycloneDDS");
  ASSERT_NE(begin, std::string::npos);
  EXPECT_EQ(text.substr(begin), loopback_configuration(Session{}.lease));
}

}  // namespace
}  // namespace ttf::bus::dds::common
