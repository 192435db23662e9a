// Lost lists, as a node counts and records them: each by its number, with every loss recorded.
#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "nodes/host/executive.h"
#include "tests/bus/layouts.h"
#include "timebase/oscillator.h"

namespace ttf::sim::drives {
namespace {

using recording::records::Hop;

struct Seen {  // a hop with its list
  Hop hop;
  std::uint32_t sequence;
  bool operator==(const Seen&) const = default;
};

struct Hops final : recording::records::Sink {
  using recording::records::Sink::on;
  std::vector<Seen> list;
  void on(const recording::records::ListHop& hop) override { list.push_back({hop.hop, hop.sequence}); }
};

struct Idle final : nodes::host::Step {
  void run(nodes::host::StepContext&) override {}
};

struct NoLines final : nodes::host::SensorLines {
  void trigger(SensorId) override {}
  void strobe(SensorId, std::uint32_t) override {}
};

struct NoCan final : bus::ports::CanPort {
  void send(const bus::ports::CanFrame&) override {}
};

// A node off FlexRay with a task that each list on its CAN activates. Fragments of 2 + 3 * 2 bytes: three elements.
struct Host {
  schedules::model::Cluster cluster = made();
  Hops hops;
  NoLines lines;
  NoCan port;
  nodes::host::Executive executive{{&cluster, NodeId{1}, timebase::Oscillator(25'000, 0, 0), {}, 0, 0, {}},
                                   {std::make_shared<Idle>()},
                                   nullptr,
                                   {&port},
                                   lines,
                                   hops};
  Microticks now{0};

  static schedules::model::Cluster made() {
    schedules::model::Cluster cluster;
    cluster.nodes.resize(2);
    cluster.pdus = {bus::list_layout(4, 10, 3)};
    schedules::model::CanBus bus;
    bus.messages = {{PduId{0}, 0x100, NodeId{0}, {}, 0}};
    cluster.can_buses = {bus};
    schedules::model::Task task;
    task.activation.kind = schedules::model::ActivationKind::kMessage;
    task.activation.port = "in";
    task.best_case = task.worst_case = task.deadline = Duration::microseconds(1);
    task.reads = {{"in", PduId{0}, schedules::model::MediumId::can(0), 0}};
    cluster.nodes[1].tasks = {task};
    return cluster;
  }
  void receive(bus::MadeList& list, int fragment) {
    now = now + Microticks{1'000};
    executive.receive_can(0, {0x100, false, list.fragment(fragment)}, now);
    executive.advance(now);
  }
};

TEST(LostLists, ATornListIsRecordedByItsOwnNumber) {
  Host host;
  bus::MadeList torn(host.cluster.pdus[0], 5, 9, 0), next(host.cluster.pdus[0], 6, 6, 0);
  host.receive(torn, 0);
  host.receive(torn, 1);
  host.receive(next, 0);
  EXPECT_EQ(host.hops.list, (std::vector<Seen>{{Hop::kTorn, 5}}));
  host.receive(next, 1);
  EXPECT_EQ(host.hops.list, (std::vector<Seen>{{Hop::kTorn, 5}, {Hop::kReceived, 6}, {Hop::kRead, 6}}));
  EXPECT_EQ(host.executive.counts().torn_lists, 1u);
}

TEST(LostLists, AListOfOneFragmentDoesNotHideTheOneItTears) {
  Host host;
  bus::MadeList torn(host.cluster.pdus[0], 5, 9, 0), next(host.cluster.pdus[0], 6, 1, 0);
  host.receive(torn, 0);
  host.receive(next, 0);
  EXPECT_EQ(host.hops.list, (std::vector<Seen>{{Hop::kTorn, 5}, {Hop::kReceived, 6}, {Hop::kRead, 6}}));
  EXPECT_EQ(host.executive.counts().torn_lists, 1u);
  EXPECT_EQ(host.executive.counts().overwritten_lists, 0u);
}

}  // namespace
}  // namespace ttf::sim::drives
