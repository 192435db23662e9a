// The wiring alone, on media made for the test: a medium only has to be registered.
#include "nodes/host/wiring.h"

#include <gtest/gtest.h>

#include <map>
#include <memory>
#include <string_view>
#include <vector>

#include "tests/nodes/host/one_node.h"

namespace ttf::nodes::host {
namespace {

constexpr PduId kOther{1};
constexpr schedules::model::MediumId kFirst = schedules::model::MediumId::can(0),
                                     kSecond = schedules::model::MediumId::can(1);

// A medium that keeps outputs, and gives the test's inputs.
struct Box final : ListMedium {
  struct Content {
    std::map<PduId, std::unique_ptr<bus::cni::IncomingList>> incoming;
    std::vector<std::uint32_t> sent;  // sequences
  };
  const schedules::model::Cluster& cluster;
  Content& content;
  Box(const schedules::model::Cluster& of, Content& in) : cluster(of), content(in) {}
  bus::cni::IncomingList& incoming(PduId pdu) override {
    auto& list = content.incoming[pdu];
    if (!list) list = std::make_unique<bus::cni::IncomingList>(cluster.pdu(pdu));
    return *list;
  }
  void send(PduId, const bus::cni::ListView& list) override { content.sent.push_back(list.sequence); }
};

struct Hops final : recording::records::Sink {
  using recording::records::Sink::on;
  struct Hop {
    recording::records::Hop what;
    std::uint32_t sequence;
    int medium;
    bool operator==(const Hop&) const = default;
  };
  using All = std::vector<Hop>;
  All hops;
  void on(const recording::records::ListHop& hop) override { hops.push_back({hop.hop, hop.sequence, hop.can_bus}); }
};

struct IdleStep final : Step {
  bool newest = false;
  explicit IdleStep(bool reads_state) : newest(reads_state) {}
  void run(StepContext&) override {}
  bool reads_newest(std::string_view) const override { return newest; }
};

// Task 0 is activated by kList from the first medium. Task 1 reads it, too, and kOther from the second.
struct Wired {
  schedules::model::Cluster cluster = bus::small_cluster(1);
  NodeTime time{NodeId{0}, timebase::Oscillator(25'000, 0, 0), nullptr};
  Hops reported;
  NodeRecords records{cluster, time, reported};
  Box::Content first, second;
  std::optional<Wiring> wiring;

  explicit Wired(bool on_first = true, bool on_second = true, bool newest = false) {
    schedules::model::Task reader = task("reader", 10), both = task("both", 10);
    reader.reads = {{"in", bus::kList, kFirst, 0}};
    reader.writes = {{"out", kOther, kSecond, 0}};
    reader.activation = {schedules::model::ActivationKind::kMessage, {}, "in", kNoSensor, ""};
    both.reads = {{"x", kOther, kSecond, 0}, {"y", bus::kList, kFirst, 0}};
    cluster.nodes[0].tasks = {reader, both};
    std::vector<Connection> media;
    if (on_first) media.push_back({kFirst, std::make_unique<Box>(cluster, first)});
    if (on_second) media.push_back({kSecond, std::make_unique<Box>(cluster, second)});
    const std::vector<std::shared_ptr<Step>> steps(2, std::make_shared<IdleStep>(newest));
    wiring.emplace(cluster, cluster.nodes[0], steps, std::move(media), time, records);
  }
  // A whole list arrives, over the given medium.
  std::vector<std::size_t> comes(schedules::model::MediumId medium, PduId pdu, std::uint32_t sequence) {
    bus::MadeList list(cluster.pdu(pdu), sequence, 3, 0);
    bus::cni::IncomingList& incoming = *(medium == kFirst ? first : second).incoming.at(pdu);
    const bus::cni::ArrivalEffect effect = incoming.arrive(list.fragment(0));
    const auto set_off = wiring->arrived({medium, pdu, effect, incoming.arrived(), incoming.torn()}, Microticks{});
    return {set_off.begin(), set_off.end()};
  }
};

using H = recording::records::Hop;

TEST(Wiring, AListActivatesWhomItIsToAndIsReportedOnce) {
  Wired wired;
  EXPECT_EQ(wired.comes(kFirst, bus::kList, 1), (std::vector<std::size_t>{0}));
  EXPECT_EQ(wired.reported.hops, (Hops::All{{H::kReceived, 1, 0}})) << "two tasks read it";
  EXPECT_TRUE(wired.comes(kSecond, kOther, 5).empty()) << "it is read, and activates nobody";
}

TEST(Wiring, AnUnreadListIsOverwrittenForEachOfItsReaders) {
  Wired wired;
  wired.comes(kFirst, bus::kList, 1);
  EXPECT_TRUE(wired.wiring->read(0, {})[0].fresh);
  wired.reported.hops.clear();
  wired.comes(kFirst, bus::kList, 2);
  EXPECT_EQ(wired.reported.hops, (Hops::All{{H::kReceived, 2, 0}, {H::kOverwritten, 1, 0}}))
      << "task 1 has not read it";
  wired.reported.hops.clear();
  wired.comes(kFirst, bus::kList, 3);
  EXPECT_EQ(wired.reported.hops, (Hops::All{{H::kReceived, 3, 0}, {H::kOverwritten, 2, 0}, {H::kOverwritten, 2, 0}}));
  EXPECT_EQ(wired.records.counts().overwritten_lists, 3u);
}

TEST(Wiring, WhereOnlyTheNewestListCountsAnOverwrittenOneIsNoLoss) {
  Wired wired(true, true, true);
  wired.comes(kFirst, bus::kList, 1);
  wired.comes(kFirst, bus::kList, 2);
  EXPECT_EQ(wired.reported.hops, (Hops::All{{H::kReceived, 1, 0}, {H::kReceived, 2, 0}}));
}

TEST(Wiring, ATaskIsGivenWhatItReadsAndItsUnusableInputsAreReported) {
  Wired wired;
  wired.comes(kFirst, bus::kList, 1);
  const std::span<Input> inputs = wired.wiring->read(1, {});
  ASSERT_EQ(inputs.size(), 2u);
  EXPECT_FALSE(inputs[0].list.has_value());
  ASSERT_TRUE(inputs[1].fresh);
  EXPECT_EQ(inputs[1].list->sequence, 1u);
  inputs[1].discarded = true;
  wired.wiring->report_discarded(1, {});
  EXPECT_EQ(wired.reported.hops.back(), (Hops::Hop{H::kDiscarded, 1, 0}));
  EXPECT_EQ(wired.records.counts().discarded_lists, 1u);
}

TEST(Wiring, AListIsFreshOnceForEachOfItsReaders) {
  Wired wired;
  wired.comes(kFirst, bus::kList, 1);
  EXPECT_TRUE(wired.wiring->read(0, {})[0].fresh);
  EXPECT_FALSE(wired.wiring->read(0, {})[0].fresh);
  EXPECT_TRUE(wired.wiring->read(1, {})[1].fresh) << "task 0 has read it, and task 1 has not";
  EXPECT_FALSE(wired.wiring->read(1, {})[1].fresh);
}

TEST(Wiring, AnOutputLeavesOverItsMediumOnce) {
  Wired wired;
  wired.wiring->outputs(0)[0].begin(9, 3, GlobalTime{});
  wired.wiring->write(0, {});
  wired.wiring->write(0, {});
  EXPECT_EQ(wired.second.sent, (std::vector<std::uint32_t>{9}));
  EXPECT_EQ(wired.reported.hops, (Hops::All{{H::kWritten, 9, 1}}));
  EXPECT_TRUE(wired.first.sent.empty());
}

TEST(Wiring, TheSameListOverAnotherMediumIsAnotherList) {
  Wired wired;
  EXPECT_TRUE(wired.wiring->arrived({kSecond, bus::kList, bus::cni::ArrivalEffect::kCompleted, 1, {}}, {}).empty());
  EXPECT_TRUE(wired.reported.hops.empty()) << "no task reads it from there";
}

// A task can neither read from nor write to a medium without its node.
TEST(Wiring, NoTaskIsConnectedToAMediumThatIsNotThere) {
  EXPECT_DEATH(Wired(false, true), "task 0 reads from medium 0, which its node is not on");
  EXPECT_DEATH(Wired(true, false), "task 0 writes to medium 1, which its node is not on");
}

}  // namespace
}  // namespace ttf::nodes::host
