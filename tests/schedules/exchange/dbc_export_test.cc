#include "schedules/exchange/dbc.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <vector>

#include "bus/wire/pdu_codec.h"
#include "bus/wire/strobe.h"
#include "core/random.h"
#include "schedules/analysis/can_load.h"
#include "schedules/model/sensor_lines.h"
#include "tests/schedules/cluster_file.h"
#include "tests/schedules/exchange/dbc_reader.h"
#include "tests/support/refusals.h"

namespace ttf::schedules::exchange {
namespace {

std::string read_shipped(const std::string& file) {
  std::ifstream stream(TTF_SOURCE_DIR "/schedules/" + file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

class DbcOfShipped : public testing::TestWithParam<std::string> {
 protected:
  const model::Cluster cluster_ = check::load_checked_cluster(shipped_path(GetParam()));
};

// The reader, from the file alone, decodes a frame as our decoder does: every signal of every element.
TEST_P(DbcOfShipped, DecodesEveryFrameAsWeDo) {
  const DbcFile file = read_dbc(dbc_text(cluster_));
  ASSERT_EQ(file.nodes.size(), cluster_.nodes.size());
  std::size_t messages = 0;
  for (const model::CanBus& bus : cluster_.can_buses)
    for (const model::CanMessage& message : bus.messages) {
      ++messages;
      ASSERT_EQ(file.messages.count(message.identifier), 1u);
      const DbcMessage& dbc = file.messages.at(message.identifier);
      const model::PduLayout& layout = cluster_.pdu(message.pdu);
      EXPECT_EQ(dbc.name, layout.name);
      EXPECT_EQ(dbc.sender, cluster_.node(message.sender).name);
      EXPECT_EQ(dbc.length, analysis::can_data_length(bus.flexible_data_rate, layout.fragment_bytes));
      EXPECT_EQ(dbc.attributes.at("CAN"), bus.name);
      EXPECT_EQ(dbc.attributes.count("VFrameFormat"), bus.flexible_data_rate ? 1u : 0u);
      ASSERT_EQ(dbc.signals.size(),
                layout.header.size() + layout.element.size() * static_cast<std::size_t>(layout.elements_per_fragment));
      RandomStream draw({.seed = 5, .index = message.identifier});
      for (int trial = 0; trial < 20; ++trial) {
        std::vector<std::byte> data(static_cast<std::size_t>(dbc.length));
        for (std::byte& byte : data) byte = static_cast<std::byte>(draw.integer(0, 255));
        const auto payload = std::span(data).first(static_cast<std::size_t>(layout.fragment_bytes));
        const auto same = [&](const model::Signal& signal, const DbcSignal& read, std::uint32_t raw) {
          ASSERT_EQ(read.raw(data), raw) << read.name;
          EXPECT_EQ(read.unit, signal.unit);
          EXPECT_EQ(read.low, signal.low);
          EXPECT_EQ(read.high, signal.high);
          if (raw <= bus::wire::highest_code(signal)) {
            EXPECT_EQ(read.physical(data), bus::wire::to_physical(signal, raw));
          }
        };
        for (std::size_t s = 0; s < layout.header.size(); ++s)
          same(layout.header[s], dbc.signal(layout.header[s].name), bus::wire::read_header_raw(layout, payload, s));
        for (int e = 0; e < layout.elements_per_fragment; ++e)
          for (std::size_t s = 0; s < layout.element.size(); ++s)
            same(layout.element[s], dbc.signal(layout.element[s].name + "_" + std::to_string(e)),
                 bus::wire::read_element_raw(layout, payload, e, s));
      }
    }
  std::size_t sensors = 0;
  for (std::size_t s = 0; s < cluster_.sensors.size(); ++s)
    if (can_of_lines(cluster_, static_cast<SensorId>(s))) ++sensors;
  EXPECT_EQ(file.messages.size(), messages + 2 * sensors + 1);  // and the frames on the channels
  EXPECT_EQ(file.messages.at(0).name, "flexray_symbol");
}

TEST_P(DbcOfShipped, NamesWhoReads) {
  const DbcFile file = read_dbc(dbc_text(cluster_));
  for (const model::Node& node : cluster_.nodes)
    for (const model::Task& task : node.tasks)
      for (const model::PortBinding& port : task.reads)
        for (std::size_t b = 0; b < cluster_.can_buses.size(); ++b)
          for (const model::CanMessage& message : cluster_.can_buses[b].messages)
            if (port.medium == model::MediumId::can(b) && message.pdu == port.pdu) {
              for (const DbcSignal& signal : file.messages.at(message.identifier).signals)
                EXPECT_NE(("," + signal.receivers + ",").find("," + node.name + ","), std::string::npos) << signal.name;
            }
}

TEST_P(DbcOfShipped, OneCanAlone) {
  for (const model::CanBus& bus : cluster_.can_buses) {
    const DbcFile file = read_dbc(dbc_text(cluster_, bus.name));
    std::size_t lines = 0;
    for (std::size_t s = 0; s < cluster_.sensors.size(); ++s)
      if (const auto can = can_of_lines(cluster_, static_cast<SensorId>(s)); can && &cluster_.can_buses[*can] == &bus)
        lines += 2;
    EXPECT_EQ(file.messages.size(), bus.messages.size() + lines);
    for (const model::CanMessage& message : bus.messages) EXPECT_EQ(file.messages.count(message.identifier), 1u);
  }
}

INSTANTIATE_TEST_SUITE_P(Clusters, DbcOfShipped,
                         testing::Values("paper_unsynchronised", "paper_synchronised", "laser_radar",
                                         "laser_radar_synchronised", "two_lasers_synchronised"),
                         [](const auto& one) { return one.param; });

// `schedule export --format dbc` makes them.
TEST(Dbc, ShippedFilesAreWhatTheClustersSay) {
  for (const char* name : {"paper_synchronised", "laser_radar"})
    EXPECT_EQ(read_shipped(std::string(name) + ".dbc"), dbc_text(check::load_checked_cluster(shipped_path(name))))
        << name;
  // The CANs of the other paradigm are the same.
  for (const auto& [one, other] : {std::pair{"paper_synchronised", "paper_unsynchronised"},
                                   std::pair{"laser_radar", "laser_radar_synchronised"}}) {
    const DbcFile a = read_dbc(dbc_text(file::load_cluster(shipped_path(one))));
    const DbcFile b = read_dbc(dbc_text(file::load_cluster(shipped_path(other))));
    ASSERT_EQ(a.messages.size(), b.messages.size()) << one;
    for (const auto& [identifier, message] : a.messages) {
      ASSERT_EQ(b.messages.count(identifier), 1u) << one;
      const DbcMessage& twin = b.messages.at(identifier);
      EXPECT_EQ(message.name, twin.name);
      ASSERT_EQ(message.signals.size(), twin.signals.size());
      for (std::size_t s = 0; s < message.signals.size(); ++s)
        EXPECT_EQ(message.signals[s].start, twin.signals[s].start);
    }
  }
}

// The comments of a list in fragments, and of one in a single frame.
TEST(Dbc, CommentsSayHowListsAreCut) {
  const DbcFile file = read_dbc(dbc_text(file::load_cluster(shipped_path("paper_synchronised"))));
  EXPECT_EQ(file.messages.at(256).comment,
            "One frame is a fragment of a list of up to 1300 elements in 93 fragments, which have one sequence number; "
            "NAME_k is element 14 * fragment + k of the list, valid if that is less than count. Lists are queued at "
            "least 79 ms apart.");
  const DbcFile alone = read_dbc(dbc_text(file::load_cluster(shipped_path("laser_radar"))));
  for (const auto& [identifier, message] : alone.messages)
    if (identifier > 0 && !message.name.ends_with("_strobe") && !message.name.ends_with("_trigger")) {
      EXPECT_EQ(message.comment.rfind("One frame is a list", 0), 0u) << identifier;
    }
}

// tests/bus/socketcan compares it with the sent bytes.
TEST(Dbc, TheChannelsSymbolsAreThereUnlessACanHasTheirIdentifier) {
  model::Cluster cluster = file::load_cluster(shipped_path("paper_synchronised"));
  const DbcMessage with = read_dbc(dbc_text(cluster)).messages.at(0);
  EXPECT_EQ(with.attributes.at("CAN"), "FlexRay");
  EXPECT_EQ(with.signal("kind").multiplexed, "M");
  for (const DbcSignal& one : with.signals) EXPECT_EQ(one.name == "kind", one.multiplexed == "M");
  cluster.can_buses[0].messages[0].identifier = 0;
  const DbcMessage without = read_dbc(dbc_text(cluster)).messages.at(0);
  EXPECT_EQ(without.attributes.at("CAN"), cluster.can_buses[0].name);
}

TEST(Dbc, ASensorsLinesAreMessagesOfItsCan) {
  const model::Cluster cluster = file::load_cluster(shipped_path("paper_synchronised"));
  const DbcFile file = read_dbc(dbc_text(cluster));
  for (const auto& [sensor, device, host, can, first] : {std::tuple{"laser", "laser", "laser_pre", "laser_can", 1u},
                                                         {"camera", "camera", "camera_pre", "camera_can", 3u}}) {
    const DbcMessage &strobe = file.messages.at(first), &trigger = file.messages.at(first + 1);
    EXPECT_EQ(strobe.name, std::string(sensor) + "_strobe");
    EXPECT_EQ(trigger.name, std::string(sensor) + "_trigger");
    EXPECT_EQ(strobe.sender, device);
    EXPECT_EQ(trigger.sender, host);
    for (const DbcMessage* one : {&strobe, &trigger}) {
      EXPECT_EQ(one->attributes.at("CAN"), can);
      EXPECT_EQ(one->attributes.count("VFrameFormat"), 0u);  // classic
      EXPECT_NE(one->comment.find("In real time"), std::string::npos);
    }
    EXPECT_EQ(trigger.length, 0);
    EXPECT_TRUE(trigger.signals.empty());
    ASSERT_EQ(strobe.signals.size(), 1u);
    EXPECT_EQ(strobe.length, 4);
    EXPECT_EQ(strobe.signals[0].receivers, host);
    const auto data = bus::wire::strobe_data(0x1234'5678);
    EXPECT_EQ(strobe.signals[0].raw(data), 0x1234'5678u);
  }
}

// In virtual time they are free, and messages may have them.
TEST(Dbc, LinesTakeIdentifiersThatNoMessageHas) {
  model::Cluster cluster = file::load_cluster(shipped_path("paper_synchronised"));
  cluster.can_buses[2].messages[0].identifier = 1;
  cluster.can_buses[0].messages[0].identifier = 2;
  const DbcFile all = read_dbc(dbc_text(cluster)), laser = read_dbc(dbc_text(cluster, "laser_can"));
  EXPECT_EQ(all.messages.at(1).name, cluster.pdu(cluster.can_buses[2].messages[0].pdu).name);
  EXPECT_EQ(all.messages.at(2).name, "laser_scan");
  EXPECT_EQ(all.messages.at(3).name, "camera_strobe");
  EXPECT_EQ(laser.messages.at(1).name, "laser_strobe");
  EXPECT_EQ(laser.messages.at(2).name, "laser_scan");
}

TEST(Dbc, NamesAreCIdentifiersAndUnique) {
  model::Cluster cluster = file::load_cluster(shipped_path("paper_synchronised"));
  cluster.nodes[0].name = "a-b";
  cluster.nodes[1].name = "a_b";
  cluster.pdus[0].name = "1\"x";
  cluster.pdus[0].header[0].name = "azimuth_0";
  const DbcFile file = read_dbc(dbc_text(cluster));
  EXPECT_EQ(file.nodes[0], "a_b");
  EXPECT_EQ(file.nodes[1], "a_b_2");
  EXPECT_EQ(file.messages.at(256).name, "_1_x");
  EXPECT_EQ(file.messages.at(256).signals[0].name, "azimuth_0");
  EXPECT_EQ(std::count_if(file.messages.at(256).signals.begin(), file.messages.at(256).signals.end(),
                          [](const DbcSignal& signal) { return signal.name == "azimuth_0_2"; }),
            1);
}

std::string refusal(const model::Cluster& cluster, const std::string& can) {
  return support::refusal_of([&] { dbc_text(cluster, can); });
}

TEST(Dbc, RefusesWhatOneFileCannotSay) {
  model::Cluster cluster = file::load_cluster(shipped_path("paper_synchronised"));
  cluster.file = "a.yaml";
  EXPECT_EQ(refusal(cluster, "laser"), "a.yaml: --can = laser: must be one of laser_can, camera_can, observation_can");
  cluster.can_buses[1].messages[0].identifier = cluster.can_buses[0].messages[0].identifier;
  cluster.can_buses[1].messages[0].line = 7;
  EXPECT_EQ(refusal(cluster, ""),
            "a.yaml:7: identifier = 256: is on two CANs, and a DBC file has one message per identifier: --can NAME "
            "writes one CAN");
  for (const model::CanBus& bus : cluster.can_buses) EXPECT_EQ(refusal(cluster, bus.name), "");
  cluster.can_buses.clear();
  EXPECT_EQ(refusal(cluster, ""), "a.yaml: has no private CAN to write a DBC file of");
}

}  // namespace
}  // namespace ttf::schedules::exchange
