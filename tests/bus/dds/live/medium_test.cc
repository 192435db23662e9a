// The real-time medium over DDS between participants of one process: its port's laws, with strangers present.
#include "bus/dds/live/medium.h"

#include <dds/dds.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "bus/dds/common/host_identity.h"
#include "bus/dds/live/listener.h"
#include "bus/dds/live/live_sample.h"
#include "core/check.h"
#include "tests/bus/dds/common/sessions.h"
#include "tests/bus/dds/live/live_lines.h"
#include "tests/laws/live_medium_laws.h"

namespace ttf::laws {
namespace {

using namespace std::chrono_literals;

// A foreign participant on a line of the session, with arbitrary messages.
class Stranger {
 public:
  Stranger(const bus::dds::common::Session& session, const bus::dds::live::LiveLinePlan& plan)
      : participant_(session.domain, session.lease) {
    dds_qos_t* const within = dds_create_qos();
    dds_qset_partition1(within, session.name.c_str());
    dds_qset_reliability(within, DDS_RELIABILITY_RELIABLE, 0);
    const auto topic =
        dds_create_topic(participant_.handle(), &ttf_LiveSample_desc, plan.topic.c_str(), nullptr, nullptr);
    const auto publisher = dds_create_publisher(participant_.handle(), within, nullptr);
    writer_ = dds_create_writer(publisher, topic, within, nullptr);
    dds_delete_qos(within);
    TTF_CHECK(writer_ > 0);
    const auto deadline = std::chrono::steady_clock::now() + 10s;
    while (dds_get_matched_subscriptions(writer_, nullptr, 0) < static_cast<int>(plan.nodes.size()))
      TTF_CHECK(std::chrono::steady_clock::now() < deadline);
  }
  void say(ttf_LiveSample sample, std::size_t size) {
    std::vector<std::uint8_t> bytes(size + 1);
    sample.bytes._buffer = bytes.data();
    sample.bytes._length = sample.bytes._maximum = static_cast<std::uint32_t>(size);
    TTF_CHECK(dds_write(writer_, &sample) == 0);
  }

 private:
  bus::dds::common::Participant participant_;
  dds_entity_t writer_ = 0;
};

template <std::size_t kMembers, bus::dds::live::Delivery kDelivery> class DdsLiveBench : public LiveBench {
 public:
  DdsLiveBench() : session_(bus::dds::common::session(kMembers)), plans_(bus::dds::live::live_lines(kMembers)) {
    for (const NodeId node : session_.members)
      members_.push_back(std::make_unique<bus::dds::live::DdsMedium>(
          session_, node, bus::dds::live::lines_of(plans_, node), kDelivery));
    for (const auto& member : members_) member->wait_ready(30s);
  }
  std::size_t members() const override { return kMembers; }
  bus::ports::LiveMedium& member(std::size_t index) override { return *members_[index]; }
  std::vector<bool> can_buses() const override { return {false, true}; }
  bool on(std::size_t member, bus::ports::Line line) const override {
    return bus::dds::live::is_on(plans_[line], NodeId{static_cast<std::uint8_t>(member)});
  }
  bool intrude(bus::ports::Line line, Intruder what) override {
    ttf_LiveSample sample{};
    sample.sender = what == Intruder::kForeign ? 200 : 0;
    sample.slot = 1;
    sample.kind = what == Intruder::kForeign ? (line < 2 ? 0 : 4) : 77;
    Stranger(session_, plans_[line]).say(sample, 8);
    std::this_thread::sleep_for(quiet());
    return true;
  }
  std::size_t flood() const override { return 3 * bus::dds::live::LiveQueue::kRoom; }
  std::chrono::milliseconds quiet() const override { return 50ms; }

 private:
  bus::dds::common::Session session_;
  std::vector<bus::dds::live::LiveLinePlan> plans_;
  std::vector<std::unique_ptr<bus::dds::live::DdsMedium>> members_;
};

using DdsLiveBenches = testing::Types<
    DdsLiveBench<2, bus::dds::live::Delivery::kBestEffort>, DdsLiveBench<5, bus::dds::live::Delivery::kBestEffort>,
    DdsLiveBench<2, bus::dds::live::Delivery::kReliable>, DdsLiveBench<5, bus::dds::live::Delivery::kReliable>>;
INSTANTIATE_TYPED_TEST_SUITE_P(Dds, LiveMediumLaws, DdsLiveBenches);

// Each malformed sample is counted and never handed over; sound ones in between are received.
TEST(DdsLiveMalformed, IsCountedInAllItsForms) {
  const bus::dds::common::Session session = bus::dds::common::session(2);
  const auto plans = bus::dds::live::live_lines(2);
  bus::dds::live::DdsMedium medium(session, NodeId{1}, bus::dds::live::lines_of(plans, NodeId{1}));
  auto received_by_one = plans;
  for (auto& plan : received_by_one) plan.nodes = {NodeId{1}};
  Stranger on_a(session, received_by_one[0]), on_can(session, received_by_one[2]);
  auto form = [number = 0u](auto&& change) mutable {
    ttf_LiveSample sample{};
    sample.slot = 1;
    sample.number = number++;
    change(sample);
    return sample;
  };
  std::uint64_t said = 0;
  const auto malformed = [&](Stranger& stranger, std::size_t size, auto&& change) {
    stranger.say(form(change), size);
    ++said;
  };
  using Sample = ttf_LiveSample;
  malformed(on_a, 8, [](Sample& s) { s.slot = 0; });
  malformed(on_a, 8, [](Sample& s) { s.slot = 2048; });
  malformed(on_a, 8, [](Sample& s) { s.kind = 4; });  // a CAN frame here
  malformed(on_a, 8, [](Sample& s) { s.tells_late = 2; });
  malformed(on_a, 7, [](Sample&) {});
  malformed(on_a, 263, [](Sample&) {});
  malformed(on_a, 60'000, [](Sample&) {});
  malformed(on_a, 0, [](Sample& s) { s.kind = 1; });  // a symbol of no duration
  malformed(on_a, 0, [](Sample& s) { s.kind = 2, s.duration = 9, s.tells_late = 1; });
  malformed(on_a, 1, [](Sample& s) { s.kind = 3, s.duration = 9; });
  malformed(on_a, 8, [](Sample& s) { s.sent = -1; });  // by no clock
  malformed(on_a, 8, [](Sample& s) { s.sent = INT64_MAX; });
  malformed(on_a, 8, [](Sample& s) { s.tells_late = 1, s.late = INT64_MIN; });
  malformed(on_a, 8, [](Sample& s) { s.tells_late = 1, s.late = INT64_MAX; });
  malformed(on_a, 0, [](Sample& s) { s.kind = 1, s.duration = INT64_MAX; });
  malformed(on_can, 8, [](Sample&) {});  // a FlexRay frame here
  malformed(on_can, 8, [](Sample& s) { s.kind = 4, s.identifier = 0x800; });
  malformed(on_can, 9, [](Sample& s) { s.kind = 5; });
  malformed(on_can, 12, [](Sample& s) { s.kind = 4; });
  malformed(on_can, 65, [](Sample& s) { s.kind = 5; });
  on_a.say(form([](Sample&) {}), 262);
  on_can.say(form([](Sample& s) { s.kind = 5, s.identifier = 0x7FF; }), 64);
  const auto deadline = std::chrono::steady_clock::now() + 10s;
  for (std::size_t received = 0; received < 2 && std::chrono::steady_clock::now() < deadline;) {
    const auto arrival = medium.receive();
    if (!arrival) continue;
    EXPECT_EQ(arrival->signal.bytes.size() + arrival->can.data.size(), received++ == 0 ? 262u : 64u);
  }
  EXPECT_FALSE(medium.receive());
  EXPECT_EQ(medium.counts().malformed, said);
  EXPECT_EQ(medium.counts().received, 2u);
}

// By the one clock that two processes share; never later than it was here.
TEST(DdsLiveTransit, IsKnownOfWhatComesFromThisHost) {
  const bus::dds::common::Session session = bus::dds::common::session(2);
  const auto plans = bus::dds::live::live_lines(2);
  bus::dds::live::DdsMedium medium(session, NodeId{1}, bus::dds::live::lines_of(plans, NodeId{1}));
  auto received_by_one = plans;
  for (auto& plan : received_by_one) plan.nodes = {NodeId{1}};
  Stranger on_a(session, received_by_one[0]);
  const std::uint64_t here = bus::dds::common::host_identity();
  const bus::ports::MachineTime now = bus::ports::host_now(), ahead = now + Duration::milliseconds(1'000'000);
  struct Said {
    std::uint64_t host;
    bus::ports::MachineTime sent;
  };
  const std::vector<Said> all{{here, now - Duration::milliseconds(5)}, {here + 1, now}, {0, now}, {here, ahead}};
  for (const Said& said : all) {
    ttf_LiveSample sample{};
    sample.slot = 1;
    sample.number = static_cast<std::uint64_t>(&said - all.data());
    sample.host = said.host;
    sample.sent = said.sent.ns;
    on_a.say(sample, 8);
  }
  std::size_t received = 0;
  const auto deadline = std::chrono::steady_clock::now() + 10s;
  while (received < all.size() && std::chrono::steady_clock::now() < deadline) {
    const auto arrival = medium.receive();
    if (!arrival) continue;
    const Said& said = all[received++];
    EXPECT_EQ(arrival->left.has_value(), said.host == here) << received;
    if (arrival->left) {
      EXPECT_EQ(*arrival->left, std::min(said.sent, arrival->received)) << received;
    }
    EXPECT_GE(arrival->received, now);
  }
  EXPECT_EQ(received, all.size());
}

// A listener receives the identifiers it was given, of a stranger that names no node; malformed frames, too.
TEST(DdsListener, ReceivesWhatNodesWouldAndWhatTheyRefuse) {
  const bus::dds::common::Session session = bus::dds::common::session(2);
  auto plans = bus::dds::live::live_lines(2);
  bus::dds::live::DdsListener listener(session, plans, {.slots = {2, 3}, .can = {{}, {0x50}}});
  auto received_by_one = plans;
  for (auto& plan : received_by_one) plan.nodes = {NodeId{1}};
  Stranger on_a(session, received_by_one[0]), on_can(session, received_by_one[3]);
  using Form = bus::ports::ReceivedFrame::Form;
  std::vector<std::pair<Form, int>> all;  // with slot or identifier
  const auto next = [&](std::size_t more) {
    const auto deadline = std::chrono::steady_clock::now() + 10s;
    for (more += all.size(); all.size() < more && std::chrono::steady_clock::now() < deadline;) {
      const auto received = listener.receive();
      if (!received) continue;
      all.emplace_back(received->form,
                       received->line == 0 ? received->slot : static_cast<int>(received->can.identifier));
      EXPECT_GT(received->at, bus::ports::MachineTime{});
      if (received->form == Form::kFollowUp) {
        EXPECT_EQ(received->late, Duration::nanoseconds(77));
      }
    }
  };
  const auto said = [](auto&& change) {
    ttf_LiveSample sample{};
    sample.slot = 2;
    sample.identifier = 0x50;
    change(sample);
    return sample;
  };
  using Sample = ttf_LiveSample;
  on_a.say(said([](Sample& s) { s.number = 0; }), 8);
  on_a.say(said([](Sample& s) { s.number = 1, s.slot = 4; }), 8);  // not received
  on_a.say(said([](Sample& s) { s.number = 2, s.slot = 3, s.tells_late = 1, s.late = 77; }), 8);
  on_a.say(said([](Sample& s) { s.number = 3, s.kind = 1, s.duration = 9; }), 0);  // a symbol
  on_a.say(said([](Sample& s) { s.number = 2; }), 8);                              // a number again
  on_a.say(said([](Sample& s) { s.sender = 200; }), 8);                            // not on the line
  on_a.say(said([](Sample& s) { s.number = 4; }), 7);                              // too short
  on_a.say(said([](Sample& s) { s.number = 4, s.slot = 3; }), 8);
  next(7);
  on_can.say(said([](Sample& s) { s.number = 0, s.kind = 5, s.identifier = 0x51; }), 8);  // not received
  on_can.say(said([](Sample& s) { s.number = 1, s.kind = 5; }), 9);                       // no length of CAN FD
  on_can.say(said([](Sample& s) { s.number = 1, s.kind = 5; }), 12);
  next(2);
  const std::vector<std::pair<Form, int>> expected{
      {Form::kFrame, 2},     {Form::kFrame, 3}, {Form::kFollowUp, 3},     {Form::kMalformed, 2}, {Form::kMalformed, 2},
      {Form::kMalformed, 2}, {Form::kFrame, 3}, {Form::kMalformed, 0x50}, {Form::kCan, 0x50}};
  EXPECT_EQ(all, expected);
  EXPECT_FALSE(listener.receive());
  EXPECT_EQ(listener.lost(), 0u);
  EXPECT_EQ(listener.failure(), "");
}

// A listener changes nothing for the members, which await no late node either.
TEST(DdsListener, IsNoMember) {
  const bus::dds::common::Session session = bus::dds::common::session(3);
  auto plans = bus::dds::live::live_lines(3);
  const bus::dds::live::DdsListener listener(session, plans, {.slots = {1}, .can = {{}, {}}});
  for (auto& plan : plans) plan.not_awaited = {NodeId{2}};
  const bus::dds::live::DdsMedium first(session, NodeId{0}, bus::dds::live::lines_of(plans, NodeId{0}));
  EXPECT_THROW(first.wait_ready(50ms), bus::dds::common::NotReady);
  const bus::dds::live::DdsMedium second(session, NodeId{1}, bus::dds::live::lines_of(plans, NodeId{1}));
  first.wait_ready(30s);
  second.wait_ready(30s);
}

}  // namespace
}  // namespace ttf::laws
