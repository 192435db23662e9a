#include "schedules/dbc_export.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "bus/wire/pdu_codec.h"
#include "core/random.h"
#include "schedules/can_load.h"
#include "tests/schedules/cluster_file.h"
#include "tests/schedules/dbc_reader.h"

namespace ttf::schedules {
namespace {

std::string read_shipped(const std::string& file) {
  std::ifstream stream(std::string(TTF_SOURCE_DIR) + "/schedules/" + file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

class DbcOfShipped : public testing::TestWithParam<std::string> {
 protected:
  const Cluster cluster_ = load_checked_cluster(shipped_path(GetParam()));
};

// What the reader makes of a frame by the file alone is what our own decoder makes of it: every signal of every
// element.
TEST_P(DbcOfShipped, DecodesEveryFrameAsWeDo) {
  const DbcFile file = read_dbc(dbc_text(cluster_));
  ASSERT_EQ(file.nodes.size(), cluster_.nodes.size());
  std::size_t messages = 0;
  for (const CanBus& bus : cluster_.can_buses)
    for (const CanMessage& message : bus.messages) {
      ++messages;
      ASSERT_EQ(file.messages.count(message.identifier), 1u);
      const DbcMessage& dbc = file.messages.at(message.identifier);
      const PduLayout& layout = cluster_.pdu(message.pdu);
      EXPECT_EQ(dbc.name, layout.name);
      EXPECT_EQ(dbc.sender, cluster_.node(message.sender).name);
      EXPECT_EQ(dbc.length, can_data_length(bus.flexible_data_rate, layout.fragment_bytes));
      EXPECT_EQ(dbc.attributes.at("CAN"), bus.name);
      EXPECT_EQ(dbc.attributes.count("VFrameFormat"), bus.flexible_data_rate ? 1u : 0u);
      ASSERT_EQ(dbc.signals.size(), layout.header.size() + layout.element.size() *
                                                               static_cast<std::size_t>(layout.elements_per_fragment));
      RandomStream draw({.seed = 5, .index = message.identifier});
      for (int trial = 0; trial < 20; ++trial) {
        std::vector<std::byte> data(static_cast<std::size_t>(dbc.length));
        for (std::byte& byte : data) byte = static_cast<std::byte>(draw.integer(0, 255));
        const auto payload = std::span(data).first(static_cast<std::size_t>(layout.fragment_bytes));
        const auto same = [&](const Signal& signal, const DbcSignal& read, std::uint32_t raw) {
          ASSERT_EQ(read.raw(data), raw) << read.name;
          EXPECT_EQ(read.unit, signal.unit);
          EXPECT_EQ(read.low, signal.low);
          EXPECT_EQ(read.high, signal.high);
          if (raw <= wire::highest_code(signal)) {
            EXPECT_EQ(read.physical(data), wire::to_physical(signal, raw));
          }
        };
        for (std::size_t s = 0; s < layout.header.size(); ++s)
          same(layout.header[s], dbc.signal(layout.header[s].name), wire::read_header_raw(layout, payload, s));
        for (int e = 0; e < layout.elements_per_fragment; ++e)
          for (std::size_t s = 0; s < layout.element.size(); ++s)
            same(layout.element[s], dbc.signal(layout.element[s].name + "_" + std::to_string(e)),
                 wire::read_element_raw(layout, payload, e, s));
      }
    }
  EXPECT_EQ(file.messages.size(), messages);
}

TEST_P(DbcOfShipped, NamesWhoReads) {
  const DbcFile file = read_dbc(dbc_text(cluster_));
  for (const Node& node : cluster_.nodes)
    for (const Task& task : node.tasks)
      for (const PortBinding& port : task.reads)
        for (std::size_t b = 0; port.can_bus && b < cluster_.can_buses.size(); ++b)
          for (const CanMessage& message : cluster_.can_buses[b].messages)
            if (b == *port.can_bus && message.pdu == port.pdu) {
              for (const DbcSignal& signal : file.messages.at(message.identifier).signals)
                EXPECT_NE(("," + signal.receivers + ",").find("," + node.name + ","), std::string::npos) << signal.name;
            }
}

TEST_P(DbcOfShipped, OneCanAlone) {
  for (const CanBus& bus : cluster_.can_buses) {
    const DbcFile file = read_dbc(dbc_text(cluster_, bus.name));
    EXPECT_EQ(file.messages.size(), bus.messages.size());
    for (const CanMessage& message : bus.messages) EXPECT_EQ(file.messages.count(message.identifier), 1u);
  }
}

INSTANTIATE_TEST_SUITE_P(Clusters, DbcOfShipped,
                         testing::Values("paper_unsynchronised", "paper_synchronised", "laser_radar",
                                         "laser_radar_synchronised"),
                         [](const auto& one) { return one.param; });

// schedule export --format dbc makes them anew.
TEST(Dbc, ShippedFilesAreWhatTheClustersSay) {
  for (const char* name : {"paper_synchronised", "laser_radar"})
    EXPECT_EQ(read_shipped(std::string(name) + ".dbc"), dbc_text(load_checked_cluster(shipped_path(name)))) << name;
  // The CANs of the other paradigm are the same.
  for (const auto& [one, other] : {std::pair{"paper_synchronised", "paper_unsynchronised"},
                                   std::pair{"laser_radar", "laser_radar_synchronised"}}) {
    const DbcFile a = read_dbc(dbc_text(load_cluster(shipped_path(one))));
    const DbcFile b = read_dbc(dbc_text(load_cluster(shipped_path(other))));
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

// The comment of a list in fragments, and of one that is a frame.
TEST(Dbc, CommentsSayHowListsAreCut) {
  const DbcFile file = read_dbc(dbc_text(load_cluster(shipped_path("paper_synchronised"))));
  EXPECT_EQ(file.messages.at(256).comment,
            "One frame is a fragment of a list of up to 1300 elements in 93 fragments, which have one sequence number; "
            "NAME_k is element 14 * fragment + k of the list, valid if that is less than count. Lists are queued at "
            "least 79 ms apart.");
  const DbcFile alone = read_dbc(dbc_text(load_cluster(shipped_path("laser_radar"))));
  for (const auto& [identifier, message] : alone.messages)
    EXPECT_EQ(message.comment.rfind("One frame is a list", 0), 0u) << identifier;
}

TEST(Dbc, NamesAreCIdentifiersAndUnique) {
  Cluster cluster = load_cluster(shipped_path("paper_synchronised"));
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

std::string refusal(const Cluster& cluster, const std::string& can) {
  try {
    dbc_text(cluster, can);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(Dbc, RefusesWhatOneFileCannotSay) {
  Cluster cluster = load_cluster(shipped_path("paper_synchronised"));
  cluster.file = "a.yaml";
  EXPECT_EQ(refusal(cluster, "laser"), "a.yaml: --can = laser: must be one of laser_can, camera_can, observation_can");
  cluster.can_buses[1].messages[0].identifier = cluster.can_buses[0].messages[0].identifier;
  cluster.can_buses[1].messages[0].line = 7;
  EXPECT_EQ(refusal(cluster, ""),
            "a.yaml:7: identifier = 256: is on two CANs, and a DBC file has one message per identifier: --can NAME "
            "writes one CAN");
  for (const CanBus& bus : cluster.can_buses) EXPECT_EQ(refusal(cluster, bus.name), "");
  cluster.can_buses.clear();
  EXPECT_EQ(refusal(cluster, ""), "a.yaml: has no private CAN to write a DBC file of");
}

}  // namespace
}  // namespace ttf::schedules
