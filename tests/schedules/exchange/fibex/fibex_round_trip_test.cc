// Export and import keep timing, controllers, slots, PDUs and signals. The exported bit positions match the
// codec's.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <bit>
#include <functional>
#include <map>
#include <pugixml.hpp>
#include <utility>

#include "bus/wire/pdu_codec.h"
#include "core/random.h"
#include "schedules/exchange/fibex/export.h"
#include "schedules/exchange/fibex/import.h"
#include "tests/schedules/cluster_file.h"
#include "tests/schedules/exchange/fibex/fibex_compare.h"

namespace ttf::schedules::exchange::fibex {
namespace {

void expect_round_trip(const model::Cluster& cluster) {
  const std::string xml = fibex_text(cluster);
  const FibexImport import = parse_fibex(xml, "cluster.xml");
  EXPECT_EQ(FibexDifference::of(cluster, import.cluster), "");
  EXPECT_EQ(import.assumed, decltype(import.assumed){});
  EXPECT_EQ(sentences(import.left_out), "");
  EXPECT_TRUE(import.foreign.empty());
  const model::Cluster again = file::parse_cluster(skeleton_yaml(import), "cluster.yaml");
  EXPECT_EQ(FibexDifference::of(cluster, again), "");
  EXPECT_EQ(fibex_text(cluster), xml);
}

class FibexShipped : public testing::TestWithParam<std::string> {
 protected:
  model::Cluster cluster_ = check::load_checked_cluster(shipped_path(GetParam()));
};
INSTANTIATE_TEST_SUITE_P(Shipped, FibexShipped, testing::ValuesIn(shipped_clusters()),
                         [](const auto& one) { return one.param; });

TEST_P(FibexShipped, IsTheSameAfterExportAndImport) { expect_round_trip(cluster_); }

// FIBEX 3.1 has no place for another round of cycles: an extension has it.
TEST(FibexRound, OfSixtyCyclesIsTheSameAfterExportAndImport) {
  model::Cluster cluster = check::load_checked_cluster(shipped_path("paper_synchronised"));
  EXPECT_EQ(fibex_text(cluster).find("CYCLE-COUNT-MAX"), std::string::npos);
  cluster.flexray.gCycleCountMax = 59;
  for (model::FrameSlot& frame : cluster.frames) {
    if (frame.repetition != 8) continue;
    frame.repetition = 10;
    frame.base_cycle += 2;
  }
  expect_round_trip(cluster);
  std::string xml = fibex_text(cluster);
  const std::string count = "CYCLE-COUNT-MAX>59<";
  ASSERT_NE(xml.find(count), std::string::npos);
  EXPECT_EQ(parse_fibex(xml, "cluster.xml").cluster.flexray.gCycleCountMax, 59);
  xml.replace(xml.find(count), count.size(), "CYCLE-COUNT-MAX>58<");
  EXPECT_THROW((void)parse_fibex(xml, "cluster.xml"), InputError);
}

std::vector<std::string> ecus_of(const std::string& xml) {
  pugi::xml_document document;
  EXPECT_TRUE(document.load_string(xml.c_str()));
  std::vector<std::string> ecus;
  for (const pugi::xml_node ecu : document.child("fx:FIBEX").child("fx:ELEMENTS").child("fx:ECUS")) {
    std::string ids = ecu.child_value("ho:SHORT-NAME");
    for (const auto& one : ecu.select_nodes(".//@ID | .//@ID-REF")) ids += std::string(" ") + one.attribute().value();
    ecus.push_back(std::string(ecu.attribute("ID").value()) + " " + ids);
  }
  return ecus;
}

// The import has neither nodes off FlexRay nor who reads a list. The ECUs are the same all the same, in their order.
TEST_P(FibexShipped, KeepsItsEcusWhenItIsExportedAgain) {
  const auto without_inputs = [](model::Cluster cluster) {
    for (model::Node& node : cluster.nodes) node.tasks.clear();
    return cluster;
  };
  const auto first = ecus_of(fibex_text(without_inputs(cluster_)));
  const auto again = ecus_of(fibex_text(parse_fibex(fibex_text(cluster_), "cluster.xml").cluster));
  ASSERT_FALSE(first.empty());
  EXPECT_EQ(first, again);
  EXPECT_EQ(first.front().substr(0, 6), "ecu_0 ");
}

TEST_P(FibexShipped, SaysWhoReceivesWhat) {
  const FibexImport import = parse_fibex(fibex_text(cluster_), "cluster.xml");
  for (std::size_t i = 0; i < import.cluster.nodes.size(); ++i) {
    std::vector<std::string> expected;  // on FlexRay, in the order of their slots
    const model::Node& node = cluster_.node(*cluster_.find_node(import.cluster.nodes[i].name));
    for (const model::FrameSlot& frame : cluster_.frames)
      for (const model::Task& task : node.tasks)
        for (const model::PortBinding& port : task.reads)
          if (port.medium.is_flexray() && port.pdu == frame.pdu &&
              std::find(expected.begin(), expected.end(), cluster_.pdu(frame.pdu).name) == expected.end())
            expected.push_back(cluster_.pdu(frame.pdu).name);
    EXPECT_EQ(import.receives[i], expected) << node.name;
  }
}

// Each parameter at either end of its range. Cluster k has the parameters with bit k in their number at the upper end, and its
// inverse has the others there. Any two parameters differ in some cluster, so the test finds a file that swaps them.
TEST(FibexRoundTrip, KeepsEveryParameterOverItsWholeRange) {
  const model::Cluster shipped = check::load_checked_cluster(shipped_path("paper_synchronised"));
  std::vector<std::function<void(model::Cluster&, bool)>> setters;  // to the upper end or the lower one
  const auto add = [&](const auto& parameters, auto&& of) {
    for (const auto& p : parameters)
      setters.emplace_back(
          [&p, of](model::Cluster& cluster, bool upper) { of(cluster).*p.member = upper ? p.high : p.low; });
  };
  const auto global = [](model::Cluster& cluster) -> model::GlobalParameters& { return cluster.flexray; };
  const auto local = [](model::Cluster& cluster) -> model::NodeParameters& { return *cluster.nodes.back().flexray; };
  add(file::kGlobalIntegers, global);
  add(file::kGlobalScaled, global);
  add(file::kNodeIntegers, local);
  add(file::kNodeScaled, local);
  for (std::size_t bit = 0; bit < std::bit_width(setters.size()); ++bit)
    for (const bool inverted : {false, true}) {
      model::Cluster cluster = shipped;
      for (std::size_t i = 0; i < setters.size(); ++i) setters[i](cluster, ((i >> bit & 1U) != 0) != inverted);
      for (model::Node& node : cluster.nodes)
        if (node.flexray) node.microtick_ps = node.flexray->pdMicrotick_ps;
      // No frame is longer than the static payload; a cluster file has no slots beyond the static ones.
      cluster.flexray.gNumberOfStaticSlots = std::max(cluster.flexray.gNumberOfStaticSlots, 40);
      SCOPED_TRACE(fmt::format("bit {}{}", bit, inverted ? ", inverted" : ""));
      expect_round_trip(cluster);
    }
  for (const bool startup : {false, true})
    for (const bool sync : {false, true}) {
      if (startup && !sync) continue;  // a startup frame is a sync frame
      for (const bool only : {false, true}) {
        model::Cluster cluster = shipped;
        model::NodeParameters& p = *cluster.nodes.back().flexray;
        p.pKeySlotUsedForStartup = startup;
        p.pKeySlotUsedForSync = sync;
        p.pKeySlotOnlyEnabled = p.pAllowHaltDueToClock = only;
        expect_round_trip(cluster);
      }
    }
}

// Random schedules: 40 static and 20 dynamic slots have one frame each, of a random list, sender, channel and
// multiplexing. Every node has random channels.
TEST(FibexRoundTrip, KeepsRandomSchedules) {
  const model::Cluster shipped = check::load_checked_cluster(shipped_path("paper_unsynchronised"));
  std::vector<NodeId> senders;
  for (std::size_t i = 0; i < shipped.nodes.size(); ++i)
    if (shipped.nodes[i].flexray) senders.push_back(static_cast<NodeId>(i));
  for (std::uint32_t run = 0; run < 20; ++run) {
    RandomStream random({.seed = 3, .purpose = Purpose::kTest, .entity = 1, .index = run});
    const auto below = [&](int limit) { return static_cast<int>(random.bits() % static_cast<std::uint64_t>(limit)); };
    model::Cluster cluster = shipped;
    cluster.frames.clear();
    cluster.topology = below(2) == 0 ? model::Topology::kBus : model::Topology::kStar;
    cluster.guardian = cluster.topology == model::Topology::kStar && below(2) == 0;
    cluster.flexray.gNetworkManagementVectorLength = below(13);
    for (model::Node& node : cluster.nodes) {
      if (!node.flexray || &node == &cluster.node(senders[0])) continue;  // the first stays on both
      node.flexray->pChannels = static_cast<model::Channels>(1 + below(3));
      node.flexray->pWakeupChannel = node.flexray->pChannels == model::Channels::kAB && below(2) == 0
                                         ? model::Channel::kB
                                         : default_wakeup(node.flexray->pChannels);
    }
    for (int slot = 1; slot <= 60; ++slot) {
      const bool dynamic = slot > cluster.flexray.gNumberOfStaticSlots;
      const int repetition = 1 << below(7);
      const int first = below(repetition);
      for (int base = first; base < repetition; base += 1 + below(repetition)) {
        model::FrameSlot frame;
        frame.slot = slot;
        frame.channels = static_cast<model::Channels>(1 + below(3));
        frame.base_cycle = base;
        frame.repetition = repetition;
        frame.sender = senders[static_cast<std::size_t>(below(static_cast<int>(senders.size())))];
        const model::Channels attached = cluster.node(frame.sender).flexray->pChannels;
        frame.channels =
            share_a_channel(frame.channels, attached)
                ? static_cast<model::Channels>(static_cast<int>(frame.channels) & static_cast<int>(attached))
                : attached;
        frame.network_management = !dynamic && below(4) == 0;
        if (below(4) != 0 || dynamic) {
          frame.pdu = static_cast<PduId>(below(static_cast<int>(cluster.pdus.size())));
          frame.fragment = below(cluster.pdu(frame.pdu).max_fragments());
        }
        if (dynamic && below(3) == 0) frame.message_id = static_cast<std::uint16_t>(below(65536));
        cluster.frames.push_back(frame);
        if (frame.channels != model::Channels::kA || dynamic) continue;
        // The other channel of the same slot is someone else's.
        frame.channels = model::Channels::kB;
        frame.sender = senders[0];
        frame.pdu = kNoPdu;
        frame.fragment = 0;
        frame.network_management = false;
        cluster.frames.push_back(frame);
      }
    }
    expect_round_trip(cluster);
    if (HasFailure()) break;
  }
}

// A second reading of FIBEX' bit positions: sawtooth counting, from the most significant bit on through the
// bytes.
std::uint32_t bits_at(const std::vector<std::byte>& payload, int position, int bits) {
  std::uint32_t raw = 0;
  int byte = position / 8, bit = position % 8;
  for (int i = 0; i < bits; ++i) {
    raw = raw << 1 | (static_cast<std::uint32_t>(payload[static_cast<std::size_t>(byte)]) >> bit & 1u);
    if (bit == 0) ++byte;
    bit = bit == 0 ? 7 : bit - 1;
  }
  return raw;
}

struct Place {
  int position = 0, bits = 0;
};

// Where PDUs have their signals, straight from the XML.
class Places {
 public:
  explicit Places(const pugi::xml_document& xml) : xml_(xml) {
    for (const char* kind : {"//fx:SIGNAL", "//fx:CODING"})
      for (const pugi::xpath_node& found : xml.select_nodes(kind))
        by_id_[found.node().attribute("ID").value()] = found.node();
  }
  // By the names of the signals.
  std::map<std::string, Place> of(const std::string& pdu) const {
    std::map<std::string, Place> places;
    for (const pugi::xpath_node& found :
         xml_.select_nodes(("//fx:PDU[ho:SHORT-NAME='" + pdu + "']//fx:SIGNAL-INSTANCE").c_str())) {
      const pugi::xml_node signal = by_id_.at(found.node().child("fx:SIGNAL-REF").attribute("ID-REF").value());
      const pugi::xml_node coding = by_id_.at(signal.child("fx:CODING-REF").attribute("ID-REF").value());
      EXPECT_STREQ(found.node().child("fx:IS-HIGH-LOW-BYTE-ORDER").text().get(), "true");
      const std::string name = signal.child("ho:SHORT-NAME").text().get();
      EXPECT_FALSE(places.contains(name)) << pdu << " has two signals " << name;
      places[name] = {std::stoi(found.node().child("fx:BIT-POSITION").text().get()),
                      std::stoi(coding.child("ho:CODED-TYPE").child("ho:BIT-LENGTH").text().get())};
    }
    return places;
  }

 private:
  const pugi::xml_document& xml_;
  std::map<std::string, pugi::xml_node> by_id_;
};

TEST_P(FibexShipped, PutsSignalsWhereTheCodecPutsTheirBits) {
  pugi::xml_document xml;
  ASSERT_TRUE(xml.load_string(fibex_text(cluster_).c_str()));
  const Places places(xml);
  RandomStream random({.seed = 9, .purpose = Purpose::kTest, .entity = 2, .index = 0});
  for (const model::PduLayout& layout : cluster_.pdus) {
    const auto in_header = places.of(layout.name + "_header"), in_elements = places.of(layout.name + "_elements");
    std::vector<std::byte> payload(static_cast<std::size_t>(layout.fragment_bytes));
    for (std::byte& byte : payload) byte = static_cast<std::byte>(random.bits());
    for (std::size_t s = 0; s < layout.header.size(); ++s) {
      if (layout.header[s].name == "spare") continue;
      ASSERT_TRUE(in_header.contains(layout.header[s].name)) << layout.name << " " << layout.header[s].name;
      const Place place = in_header.at(layout.header[s].name);
      EXPECT_EQ(bits_at(payload, place.position, place.bits), bus::wire::read_header_raw(layout, payload, s));
    }
    const std::vector<std::byte> elements(payload.begin() + layout.header_bits / 8, payload.end());
    for (int e = 0; e < layout.elements_per_fragment; ++e)
      for (std::size_t s = 0; s < layout.element.size(); ++s) {
        if (layout.element[s].name == "spare") continue;
        const std::string name = fmt::format("{}_{}", layout.element[s].name, e);
        ASSERT_TRUE(in_elements.contains(name)) << layout.name << " " << name;
        const Place place = in_elements.at(name);
        EXPECT_EQ(bits_at(elements, place.position, place.bits), bus::wire::read_element_raw(layout, payload, e, s))
            << name;
      }
  }
}

TEST(FibexExport, ByHand) {
  pugi::xml_document xml;
  const std::string text = fibex_text(check::load_checked_cluster(shipped_path("paper_synchronised")));
  ASSERT_TRUE(xml.load_string(text.c_str()));
  const auto at = [&](const char* path) { return std::string(xml.select_node(path).node().text().get()); };
  EXPECT_EQ(at("/fx:FIBEX/fx:ELEMENTS/fx:CLUSTERS/fx:CLUSTER/fx:SPEED"), "10000000");
  EXPECT_EQ(at("//fx:CLUSTER/flexray:CYCLE"), "5000");
  EXPECT_EQ(at("//fx:CLUSTER/flexray:SAMPLE-CLOCK-PERIOD"), "0.0125");
  EXPECT_EQ(at("//fx:CLUSTER/flexray:WAKE-UP/flexray:WAKE-UP-SYMBOL-RX-WINDOW"), "301");
  EXPECT_EQ(at("//fx:ECU[ho:SHORT-NAME='fusion']//flexray:KEY-SLOT-USAGE/flexray:STARTUP-SYNC"), "4");
  EXPECT_EQ(at("//fx:ECU[ho:SHORT-NAME='fusion']//flexray:MICROTICK"), "0.025");
  EXPECT_EQ(at("//fx:ECU[ho:SHORT-NAME='fusion']//flexray:MAX-DRIFT"), "601");
  // The image's last fragment: slot 34, cycles 1, 9, ...
  const std::string frame =
      xml.select_node("//fx:FRAME[ho:SHORT-NAME='image_12_slot_34_cycle_1']").node().attribute("ID").value();
  const std::string timing =
      "//fx:CHANNEL[flexray:FLEXRAY-CHANNEL-NAME='B']//fx:FRAME-TRIGGERING[fx:FRAME-REF/@ID-REF='" + frame +
      "']/fx:TIMINGS/fx:ABSOLUTELY-SCHEDULED-TIMING/";
  EXPECT_EQ(at((timing + "fx:SLOT-ID").c_str()), "34");
  EXPECT_EQ(at((timing + "fx:BASE-CYCLE").c_str()), "1");
  EXPECT_EQ(at((timing + "fx:CYCLE-REPETITION").c_str()), "8");
  // In an image object 60 bits precede the speed, and the first object has 192 bits: bit 252 is the fifth of
  // byte 31.
  const Place speed = Places(xml).of("image_elements").at("speed_1");
  EXPECT_EQ(speed.position, 31 * 8 + 3);
  EXPECT_EQ(speed.bits, 14);
  EXPECT_EQ(at("//fx:PDU[ho:SHORT-NAME='image']/fx:MULTIPLEXER/fx:SWITCH/fx:BIT-POSITION"), "23");
  EXPECT_EQ(at("//fx:PDU[ho:SHORT-NAME='image']/fx:MULTIPLEXER//fx:SWITCHED-PDU-INSTANCE[13]/fx:SWITCH-CODE"), "12");
  EXPECT_EQ(at("//fx:CODING[ho:SHORT-NAME='image_speed']//ho:COMPU-NUMERATOR/ho:V[1]"), "-81.92");
  EXPECT_EQ(at("//fx:CODING[ho:SHORT-NAME='image_speed']//ho:COMPU-NUMERATOR/ho:V[2]"), "0.01");
  EXPECT_NEAR(std::stod(at("//fx:CODING[ho:SHORT-NAME='image_speed']//ho:UPPER-LIMIT")), 81.91, 1e-12);
}

}  // namespace
}  // namespace ttf::schedules::exchange::fibex
