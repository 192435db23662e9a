// The records give a measurement's whole way: every arrow carries its id, on every clock.
#include <gtest/gtest.h>

#include <map>
#include <set>
#include <tuple>
#include <vector>

#include "tests/sim/drives/drive_fixture.h"

namespace ttf::sim::drives {
namespace {

using fusion::strategies::StrategyKind;

// Where a list was seen, by the measurement it names: each arrow once.
using Arrow = std::tuple<std::string, PduId, NodeId>;

struct Ways final : recording::records::Sink {
  using recording::records::Sink::on;
  const schedules::model::Cluster& cluster;
  std::map<MeasurementId, recording::records::Stamp> measured;
  std::map<MeasurementId, std::set<Arrow>> arrows;
  std::set<MeasurementId> fused, in_images;
  std::map<std::pair<std::uint8_t, PduId>, std::uint32_t> newest_on_can;
  std::vector<recording::records::TaskRun> runs;
  int can_frames = 0, slot_frames = 0, image_frames = 0, truths = 0, fixes = 0;

  explicit Ways(const schedules::model::Cluster& c) : cluster(c) {}

  void arrow(const char* what, PduId pdu, SensorId sensor, std::uint32_t sequence, NodeId node) {
    EXPECT_EQ(sensor, pdu == kNoPdu ? kNoSensor : cluster.pdu(pdu).sensor);
    if (sensor != kNoSensor) arrows[{sensor, sequence}].insert({what, pdu, node});
  }
  // Later, or at the same instant, on all three clocks; and by about as much.
  static void expect_in_order(const recording::records::Stamp& a, const recording::records::Stamp& b) {
    EXPECT_EQ(a.node, b.node);
    const std::int64_t elapsed = (b.true_time - a.true_time).ns;
    EXPECT_GE(elapsed, 0);
    EXPECT_NEAR(static_cast<double>((b.local - a.local).ns), static_cast<double>(elapsed),
                60.0 + 0.0015 * static_cast<double>(elapsed));
    EXPECT_NEAR(static_cast<double>((b.global - a.global).ns), static_cast<double>(elapsed),
                2000.0 + 0.0015 * static_cast<double>(elapsed));
  }

  void on(const recording::records::Measured& r) override { measured[r.id] = r.stamp; }
  void on(const recording::records::CanFrameSent& r) override {
    ++can_frames;
    expect_in_order(r.start, r.end);
    EXPECT_LT(r.start.true_time, r.end.true_time);
    arrow("can frame", r.pdu, r.sensor, r.sequence, r.start.node);
    const auto [entry, first] = newest_on_can.try_emplace({r.bus, r.pdu}, r.sequence);
    EXPECT_TRUE(first || r.sequence == entry->second || r.sequence == entry->second + 1) << r.sequence;
    entry->second = r.sequence;
  }
  void on(const recording::records::SlotFrameSent& r) override {
    ++slot_frames;
    expect_in_order(r.stamp, r.end);
    if (r.null_frame) return;
    arrow("slot frame", r.pdu, r.sensor, r.sequence, r.stamp.node);
    if (r.pdu != kNoPdu && r.sensor == kNoSensor) ++image_frames;
  }
  void on(const recording::records::ListHop& r) override {
    constexpr const char* kNames[] = {"", "written", "sent", "received", "torn", "read", "overwritten", "stale"};
    arrow(kNames[static_cast<std::size_t>(r.hop)], r.pdu, r.sensor, r.sequence, r.stamp.node);
  }
  void on(const recording::records::TaskRun& r) override {
    expect_in_order(r.activated, r.start);
    expect_in_order(r.start, r.end);
    runs.push_back(r);
  }
  void on(const recording::records::FusionInput& r) override {
    arrow("fusion input", r.pdu, r.sensor, r.sequence, r.stamp.node);
  }
  void on(const recording::records::ListFused& r) override { fused.insert(r.id); }
  void on(const recording::records::ImageWritten& r) override { in_images.insert(r.newest.begin(), r.newest.end()); }
  void on(const recording::records::TruthState& r) override {
    ++truths;
    // The cluster's time runs as fast as its oscillators on average. A device off the bus has its own time,
    // from power-on.
    const std::int64_t elapsed = (r.at - sim::engine::kFirstCycle).ns;
    EXPECT_NEAR(static_cast<double>((r.global - GlobalTime{}).ns), static_cast<double>(elapsed),
                (cluster.node(r.node).flexray ? 3e3 : 2e6) + 1e-4 * static_cast<double>(elapsed));
  }
  void on(const recording::records::ReferenceFix& r) override {
    ++fixes;
    EXPECT_EQ(r.measured_local.ns, r.measured_true.ns);
  }
};

// The arrows of every list of this sensor: both devices' and hosts' CANs, the gateway, both channels, the
// fusion node.
std::set<Arrow> expected_arrows(const schedules::model::Cluster& cluster, SensorId sensor) {
  std::set<Arrow> arrows;
  for (std::size_t n = 0; n < cluster.nodes.size(); ++n) {
    const auto node = static_cast<NodeId>(n);
    for (const schedules::model::Task& task : cluster.nodes[n].tasks) {
      for (const schedules::model::PortBinding& port : task.writes) {
        if (cluster.pdu(port.pdu).sensor != sensor) continue;
        for (const char* what : {"written", "sent", port.medium.is_can() ? "can frame" : "slot frame"})
          arrows.insert({what, port.pdu, node});
      }
      for (const schedules::model::PortBinding& port : task.reads) {
        if (cluster.pdu(port.pdu).sensor != sensor) continue;
        for (const char* what : {"received", "read"}) arrows.insert({what, port.pdu, node});
        if (task.step == "fusion") arrows.insert({"fusion input", port.pdu, node});
      }
    }
  }
  return arrows;
}

class WaysOfMeasurements : public testing::TestWithParam<StrategyKind> {};

TEST_P(WaysOfMeasurements, EveryArrowCarriesTheMeasurementsId) {
  const Drive drive("scenarios/paper_scenario1.yaml", GetParam());
  Ways ways(drive.cluster);
  drive.run(ways);
  ASSERT_GT(ways.fused.size(), 60u);
  int whole = 0;
  for (const auto& [id, arrows] : ways.arrows) ASSERT_TRUE(ways.measured.contains(id)) << "an arrow of no measurement";
  for (const MeasurementId& id : ways.fused) {
    ASSERT_TRUE(ways.measured.contains(id));
    ASSERT_EQ(ways.arrows[id], expected_arrows(drive.cluster, id.sensor))
        << "sensor " << index_of(id.sensor) << " #" << id.sequence;
    ++whole;
  }
  EXPECT_GT(whole, 60);
  for (const MeasurementId& id : ways.in_images) EXPECT_TRUE(ways.fused.contains(id));
  EXPECT_GT(ways.in_images.size(), 10u);
  EXPECT_GT(ways.image_frames, 50);
  EXPECT_GT(ways.can_frames, 300);
  EXPECT_GT(ways.truths, 50);
  EXPECT_GT(ways.fixes, 5);
}

// With counters of four bits on the buses every number is still recognised: the recorded one counts on.
TEST_P(WaysOfMeasurements, SequenceNumbersCountOnWhereTheFieldWraps) {
  const Drive shipped("scenarios/paper_scenario1.yaml", GetParam());
  Drive wrapping = shipped;
  for (schedules::model::PduLayout& pdu : wrapping.cluster.pdus)
    pdu.header[*schedules::model::find_signal(pdu.header, "sequence")].bits = 4;
  Ways expected(shipped.cluster), found(wrapping.cluster);
  shipped.run(expected);
  wrapping.run(found);
  EXPECT_GT(found.fused.rbegin()->sequence, 16u);
  EXPECT_EQ(found.fused, expected.fused);
  EXPECT_EQ(found.in_images, expected.in_images);
  EXPECT_EQ(found.arrows, expected.arrows);
}

INSTANTIATE_TEST_SUITE_P(Strategies, WaysOfMeasurements, testing::ValuesIn(fusion::strategies::kAllStrategies),
                         [](const auto& strategy) { return std::string(name_of(strategy.param)); });

}  // namespace
}  // namespace ttf::sim::drives
