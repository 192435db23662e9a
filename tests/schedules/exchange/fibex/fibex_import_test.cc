// Other tools' files, by hand. Supported parts are imported correctly, unsupported ones are named with their
// line, wrong ones are refused.
#include "schedules/exchange/fibex/import.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "schedules/exchange/fibex/export.h"
#include "tests/schedules/cluster_file.h"
#include "tests/schedules/exchange/fibex/fibex_compare.h"
#include "tests/schedules/exchange/fibex/fibex_example.h"
#include "tests/support/refusals.h"

namespace ttf::schedules::exchange::fibex {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

int line_of(const std::string& text, const std::string& what) {
  const auto at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  return 1 + static_cast<int>(std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n'));
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

std::string refusal_of(const std::string& text) {
  return support::refusal_of([&] { parse_fibex(text, "demo.xml"); });
}

class Powertrain : public testing::Test {
 protected:
  const FibexImport import_ = parse_fibex(kPowertrain, "demo.xml");
  const model::Cluster& cluster_ = import_.cluster;
};

TEST_F(Powertrain, TimingIsWhatTheFileSaysAndWhatFollows) {
  const model::GlobalParameters& g = cluster_.flexray;
  EXPECT_EQ(cluster_.name, "Powertrain");
  EXPECT_EQ(g.baudrate, 10'000'000);
  EXPECT_EQ(g.gdMacrotick_ps, 1'250'000);
  EXPECT_EQ(g.gdCycle_ps, 5'000'000'000);
  EXPECT_EQ(g.gMacroPerCycle, 4000);  // not in the file: 5000 us / 1.25 us
  EXPECT_EQ(g.gdBit_ps, 100'000);     // not in the file: one over the bit rate
  EXPECT_EQ(g.gNumberOfStaticSlots, 60);
  EXPECT_EQ(g.gdStaticSlot, 43);
  EXPECT_EQ(g.gNumberOfMinislots, 210);
  EXPECT_EQ(g.gdNIT, 6);
  EXPECT_EQ(g.gOffsetCorrectionStart, 3632);
  EXPECT_EQ(g.gPayloadLengthStatic, 21);
  for (const char* assumed :
       {"flexray.gMacroPerCycle", "flexray.gdBit", "flexray.gListenNoise", "flexray.gdMaxPropagationDelay",
        "nodes.Engine.flexray.pLatestTx", "nodes.ESP.flexray.pdMicrotick"})
    EXPECT_EQ(import_.assumed.count(assumed), 1u) << assumed;
  for (const char* stated : {"flexray.gdNIT", "flexray.baudrate", "nodes.Engine.flexray.pDecodingCorrection"})
    EXPECT_EQ(import_.assumed.count(stated), 0u) << stated;
}

TEST_F(Powertrain, ControllersHaveTheirKeySlotsAndWhatFollowsFromTheCycle) {
  ASSERT_EQ(cluster_.nodes.size(), 2u);
  const model::Node& engine = cluster_.nodes[0];
  EXPECT_EQ(engine.name, "Engine");
  EXPECT_EQ(engine.flexray->pKeySlotId, 1);
  EXPECT_TRUE(engine.flexray->pKeySlotUsedForStartup && engine.flexray->pKeySlotUsedForSync);
  EXPECT_TRUE(engine.flexray->pAllowHaltDueToClock);
  EXPECT_EQ(engine.flexray->pdMicrotick_ps, 25'000);
  EXPECT_EQ(engine.flexray->pSamplesPerMicrotick, 2);
  EXPECT_EQ(engine.flexray->pMicroPerCycle, 200'000);
  EXPECT_EQ(engine.flexray->pRateCorrectionOut, 601);  // 200000 * 0.003 / 0.9985
  EXPECT_EQ(engine.flexray->pdListenTimeout, 401'202);
  const model::Node& esp = cluster_.nodes[1];
  EXPECT_EQ(esp.name, "ESP");
  EXPECT_EQ(esp.flexray->pKeySlotId, 13);  // has no controller in the file: its first slot
  EXPECT_FALSE(esp.flexray->pKeySlotUsedForSync);
  EXPECT_THAT(import_.receives[0], ElementsAre());
  EXPECT_THAT(import_.receives[1], ElementsAre("Startup"));
}

TEST_F(Powertrain, SlotsHaveTheirCyclesChannelsAndSenders) {
  ASSERT_EQ(cluster_.frames.size(), 3u);
  const model::FrameSlot& startup = cluster_.frames[0];
  EXPECT_EQ(startup.slot, 1);
  EXPECT_EQ(startup.base_cycle, 7);  // CYCLE-COUNTER: this one of the 64 cycles
  EXPECT_EQ(startup.repetition, 64);
  EXPECT_EQ(startup.channels, model::Channels::kA);
  EXPECT_EQ(cluster_.node(startup.sender).name, "Engine");
  EXPECT_EQ(startup.line, line_of(kPowertrain, "<fx:FRAME-TRIGGERING ID=\"ft2\">"));
  const model::FrameSlot& torque = cluster_.frames[1];
  EXPECT_EQ(torque.slot, 13);
  EXPECT_EQ(torque.base_cycle, 1);
  EXPECT_EQ(torque.repetition, 2);
  EXPECT_EQ(torque.channels, model::Channels::kAB);  // one frame on both
  EXPECT_EQ(cluster_.node(torque.sender).name, "ESP");
  EXPECT_EQ(torque.pdu, kNoPdu);
  const model::FrameSlot& dynamic = cluster_.frames[2];  // it carries no list, and has its length
  EXPECT_EQ(dynamic.slot, 61);
  EXPECT_EQ(dynamic.pdu, kNoPdu);
  EXPECT_EQ(dynamic.payload_bytes, 42);
  EXPECT_THAT(import_.contents, ElementsAre("", "TorqueInfo carries CrankTorque at byte 0, Reserve at byte 4", ""));
}

TEST_F(Powertrain, ConnectorsSayWhatANodeIsAttachedTo) {
  const model::NodeParameters& engine = *cluster_.node(*cluster_.find_node("Engine")).flexray;
  EXPECT_EQ(engine.pChannels, model::Channels::kA);
  EXPECT_EQ(engine.pWakeupChannel, model::Channel::kA);
  EXPECT_FALSE(import_.assumed.contains("nodes.Engine.flexray.pChannels"));
  EXPECT_FALSE(import_.assumed.contains("nodes.Engine.flexray.pWakeupChannel"));
  // Its connector names no channel.
  EXPECT_EQ(cluster_.node(*cluster_.find_node("ESP")).flexray->pChannels, model::Channels::kAB);
  EXPECT_TRUE(import_.assumed.contains("nodes.ESP.flexray.pChannels"));
}

TEST_F(Powertrain, OrdinaryPdusKeepTheirSignalsBesideTheCluster) {
  EXPECT_TRUE(cluster_.pdus.empty());
  ASSERT_EQ(import_.foreign.size(), 2u);
  const FibexPdu& pdu = import_.foreign[0].pdu;
  EXPECT_EQ(pdu.name, "CrankTorque");
  EXPECT_EQ(pdu.bytes, 4);
  ASSERT_EQ(pdu.signals.size(), 2u);
  const FibexSignal& torque = pdu.signals[0];
  EXPECT_EQ(torque.name, "TorqueReq");
  EXPECT_EQ(torque.position, 0);
  EXPECT_FALSE(torque.high_low);
  EXPECT_EQ(torque.offset(), std::nullopt);  // over two bytes
  EXPECT_EQ(torque.meaning.bits, 16);
  EXPECT_EQ(torque.meaning.low, -0.5);  // (-4 + raw) / 8
  EXPECT_EQ(torque.meaning.resolution, 0.125);
  EXPECT_EQ(torque.meaning.high, 6000.0);
  EXPECT_EQ(torque.meaning.unit, "Nm");
  EXPECT_EQ(torque.unlike, "");
  const FibexSignal& angle = pdu.signals[1];
  EXPECT_EQ(angle.name, "CrankAngle");
  EXPECT_EQ(angle.position, 16);
  EXPECT_THAT(angle.unlike, HasSubstr("A_INT16"));
}

TEST_F(Powertrain, PartsLeftOutAreNamedWithTheirLines) {
  const std::string elements = "fx:FIBEX/fx:ELEMENTS/";
  struct Expected {
    std::string path, near, word;
  };
  const Expected expected[] = {
      {elements + "fx:CLUSTERS/fx:CLUSTER/flexray:MAX-INITIALIZATION-ERROR", "<flexray:MAX-INIT", "not understood"},
      {elements + "fx:CLUSTERS/fx:CLUSTER", "<fx:CLUSTER ID=\"C2\">", "FlexRay cluster"},
      {elements + "fx:GATEWAYS", "<fx:GATEWAYS>", "not understood"},
      {"flexray:MAX-DYNAMIC-PAYLOAD-LENGTH = 127", "<fx:CONTROLLER ID=\"E1C\"",
       "the length of Engine's longest dynamic frame, 21"},
      {"fx:PDU", "<fx:PDU ID=\"pdu1\">", "CrankTorque"},
      {"fx:PDU", "<fx:PDU ID=\"pdu2\">", "Reserve"},
      {elements + "fx:CODINGS/fx:CODING/ho:COMPU-METHODS/ho:COMPU-METHOD/ho:PHYS-CONSTRS/ho:SCALE-CONSTR",
       "<ho:SCALE-CONSTR", "lower limit other than -0.5"},
  };
  std::vector<std::string> found;
  for (const Finding& finding : import_.left_out) found.push_back(finding.sentence());
  for (const Expected& one : expected) {
    const std::string begin = fmt::format("demo.xml:{}: {}", line_of(kPowertrain, one.near), one.path);
    EXPECT_THAT(found, testing::Contains(testing::AllOf(testing::StartsWith(begin), HasSubstr(one.word))));
  }
  EXPECT_EQ(found.size(), std::size(expected)) << sentences(import_.left_out);
}

TEST_F(Powertrain, BecomesAClusterFileThatLoads) {
  const std::string yaml = skeleton_yaml(import_);
  const model::Cluster again = file::parse_cluster(yaml, "cluster.yaml");
  EXPECT_EQ(FibexDifference::of(cluster_, again), "");
  EXPECT_FALSE(again.describes_tasks());
  const FibexImport twice = parse_fibex(fibex_text(again), "again.xml");
  EXPECT_EQ(FibexDifference::of(cluster_, twice.cluster), "") << "exported again, nothing of the bus is lost";
  for (const char* said :
       {"gdBit: 0.1   # us, assumed", "gdMacrotick: 1.25   # us\n", "# receives Startup", "tasks: {}   # to be added",
        "# CrankTorque: 4 bytes, no list", "#   bit 0, low byte first: {name: TorqueReq, unit: Nm, bits: 16, low: -0.5",
        "# TorqueInfo carries CrankTorque at byte 0", "#   demo.xml:"})
    EXPECT_THAT(yaml, HasSubstr(said));
}

TEST(FibexObjects, AListOfAnotherToolIsAList) {
  const FibexImport import = parse_fibex(kObjects, "objects.xml");
  ASSERT_EQ(import.cluster.pdus.size(), 1u) << sentences(import.left_out);
  const model::PduLayout& list = import.cluster.pdus[0];
  EXPECT_EQ(list.name, "objects");
  EXPECT_EQ(list.fragment_bytes, 8);
  EXPECT_EQ(list.elements_per_fragment, 2);
  EXPECT_EQ(list.max_elements, 4);  // absent in the file: as many as fit
  EXPECT_EQ(list.header_bits, 8);
  EXPECT_EQ(list.element_bits, 22);
  std::vector<std::string> names;
  std::vector<int> bits;
  for (const auto* signals : {&list.header, &list.element})
    for (const model::Signal& signal : *signals) names.push_back(signal.name), bits.push_back(signal.bits);
  EXPECT_THAT(names, ElementsAre("sequence", "fragment", "count", "x", "v"));
  EXPECT_THAT(bits, ElementsAre(4, 1, 3, 12, 10));
  EXPECT_EQ(list.element[0].unit, "m");
  EXPECT_EQ(list.element[0].low, -100.0);
  EXPECT_EQ(list.element[0].resolution, 0.05);
  ASSERT_EQ(import.cluster.frames.size(), 2u);
  for (int f = 0; f < 2; ++f) {
    EXPECT_EQ(import.cluster.frames[static_cast<std::size_t>(f)].slot, 8 + f);
    EXPECT_EQ(import.cluster.frames[static_cast<std::size_t>(f)].fragment, f);
    EXPECT_EQ(import.cluster.frames[static_cast<std::size_t>(f)].pdu, PduId{0});
  }
  // Only the fragments' order is uncertain.
  ASSERT_EQ(import.left_out.size(), 2u) << sentences(import.left_out);
  EXPECT_THAT(import.left_out[0].sentence(), HasSubstr("Objects1: does not say which fragment it carries"));
  // The rest of the cycle: 5000 - 45 * 100; a macrotick of 2 us, 5 Mbit/s.
  EXPECT_EQ(import.cluster.flexray.gdNIT, 500);
  EXPECT_EQ(import.cluster.flexray.gOffsetCorrectionStart, 4501);
  EXPECT_EQ(import.cluster.flexray.gdCycle_ps, 10'000'000'000);
  EXPECT_EQ(import.cluster.flexray.gdBit_ps, 200'000);
  const model::Cluster again = file::parse_cluster(skeleton_yaml(import), "cluster.yaml");
  EXPECT_EQ(FibexDifference::of(import.cluster, again), "");
}

TEST(FibexObjects, AForeignMultiplexerIsDescribed) {
  const FibexImport import =
      parse_fibex(replaced(kObjects, "<SHORT-NAME>sequence<", "<SHORT-NAME>number<"), "objects.xml");
  const std::string yaml = skeleton_yaml(import);
  for (const char* said :
       {"#   always: head\n", "#   from bit 8, where the 1 bits at bit 3 are 1: part\n",
        "#   bit 37, high byte first: {name: v_1, bits: 10}\n", "# Objects1 carries objects at byte 0"})
    EXPECT_THAT(yaml, HasSubstr(said));
}

TEST(FibexObjects, SlotsBehindTheStaticOnesAreDynamic) {
  const std::string text =
      replaced(replaced(kObjects, "<f:SLOT-ID>8<", "<f:SLOT-ID>46<"), "<f:SLOT-ID>9<", "<f:SLOT-ID>47<");
  const auto with_minislots = [&](const char* count) {
    return parse_fibex(replaced(text, "<flexray:MACROTICK>",
                                fmt::format("<flexray:NUMBER-OF-MINISLOTS>{}</flexray:NUMBER-OF-"
                                            "MINISLOTS><flexray:MACROTICK>",
                                            count)
                                    .c_str()),
                       "objects.xml");
  };
  const FibexImport import = with_minislots("60");
  ASSERT_EQ(import.cluster.frames.size(), 2u) << sentences(import.left_out);
  EXPECT_EQ(import.cluster.frames[1].slot, 47);
  EXPECT_EQ(import.cluster.frames[1].pdu, PduId{0});
  EXPECT_TRUE(is_dynamic(import.cluster.flexray, import.cluster.frames[1]));
  EXPECT_EQ(file::parse_cluster(skeleton_yaml(import), "cluster.yaml").frames.size(), 2u);
  const FibexImport short_segment = with_minislots("1");
  EXPECT_EQ(short_segment.cluster.frames.size(), 1u);
  EXPECT_THAT(sentences(short_segment.left_out),
              HasSubstr("slot 47: is left out: it is beyond the static slots and the minislots"));
  // A frame whose length differs from its contents'.
  const FibexImport longer =
      parse_fibex(replaced(replaced(text, "<flexray:MACROTICK>",
                                    "<flexray:NUMBER-OF-MINISLOTS>60</flexray:NUMBER-OF-MINISLOTS><flexray:MACROTICK>"),
                           "<SHORT-NAME>Objects2</SHORT-NAME><f:BYTE-LENGTH>8<",
                           "<SHORT-NAME>Objects2</SHORT-NAME><f:BYTE-LENGTH>20<"),
                  "objects.xml");
  EXPECT_THAT(sentences(longer.left_out),
              HasSubstr("20 bytes: is left out: in the dynamic segment Objects2 is as long as its "
                        "fragment, 8 bytes"));
}

// Each is no longer a list, for the given reason; the rest of the file is still imported.
TEST(FibexObjects, APduThatIsNoListIsLeftOutWithTheReason) {
  const std::pair<const char*, std::pair<const char*, const char*>> edits[] = {
      {"<SHORT-NAME>sequence<", {"<SHORT-NAME>number<", "no signals sequence, fragment and count"}},
      {"<f:BIT-POSITION>3</f:BIT-POSITION>\n",
       {"<f:BIT-POSITION>4</f:BIT-POSITION>\n", "its switch is not the signal fragment"}},
      {"<f:SWITCH-CODE>1<", {"<f:SWITCH-CODE>2<", "switch codes are not 0, 1"}},
      {"<f:PDU-REF ID-REF=\"part\"/><f:SWITCH-CODE>1",
       {"<f:PDU-REF ID-REF=\"head\"/><f:SWITCH-CODE>1", "same signals"}},
      {"<f:BIT-POSITION>15<", {"<f:BIT-POSITION>23<", "does not follow the header"}},
      {"<f:BIT-POSITION>17<", {"<f:BIT-POSITION>16<", "x_1: it does not follow"}},
      {"<V>0.05</V>", {"<V>-0.05</V>", "falls as the raw one rises"}},
      {"\"A_UINT16\"><BIT-LENGTH>10", {"\"A_INT16\"><BIT-LENGTH>10", "not unsigned"}},
      {"<SHORT-NAME>objects</SHORT-NAME><f:BYTE-LENGTH>8",
       {"<SHORT-NAME>objects</SHORT-NAME><f:BYTE-LENGTH>6", "do not fit"}},
  };
  for (const auto& [from, edit] : edits) {
    const FibexImport import = parse_fibex(replaced(kObjects, from, edit.first), "objects.xml");
    EXPECT_TRUE(import.cluster.pdus.empty()) << from;
    EXPECT_THAT(sentences(import.left_out), HasSubstr(edit.second)) << from;
    EXPECT_EQ(import.cluster.frames.size(), 2u);
    file::parse_cluster(skeleton_yaml(import), "cluster.yaml");
  }
}

TEST(FibexImport, MistakesAreRefusedWithLineAndValue) {
  struct Mistake {
    std::string from, to, near, expected;
  };
  const Mistake mistakes[] = {
      {"MACROTICK>1.250000<", "MACROTICK>7<", "MACROTICK>7<",
       "MACROTICK = 7: must be 1..6 us, exact to 1 ps (gdMacrotick)"},
      {"MACROTICK>1.250000<", "MACROTICK>1.2500000001<", "MACROTICK>1.25", "exact to 1 ps"},
      {"<flexray:N-I-T>6<", "<flexray:N-I-T>x<", "<flexray:N-I-T>", "N-I-T = x: must be 2..805 macroticks (gdNIT)"},
      {"<flexray:CYCLE>5000<", "<flexray:CYCLE>5001<", "<fx:CLUSTER ID=\"C1\"", "whole number of macroticks"},
      {"<flexray:CYCLE>5000</flexray:CYCLE>", "", "<fx:CLUSTER ID=\"C1\"", "two of flexray:CYCLE"},
      {"<flexray:CYCLE>5000</flexray:CYCLE>", "<flexray:MACRO-PER-CYCLE>16000</flexray:MACRO-PER-CYCLE>",
       "<fx:CLUSTER ID=\"C1\"", "parameters from which gdCycle follows in 10..16000 us"},
      {"<flexray:STATIC-SLOT>43</flexray:STATIC-SLOT>", "", "<fx:CLUSTER ID=\"C1\"",
       "flexray:STATIC-SLOT (gdStaticSlot)"},
      {"SAWTOOTH", "MONOTONE", "<fx:CLUSTER ID=\"C1\"", "SAWTOOTH"},
      {"<fx:SLOT-ID>13</fx:SLOT-ID>", "<fx:SLOT-ID>0</fx:SLOT-ID>", "<fx:SLOT-ID>0",
       "SLOT-ID = 0: must be a whole number, 1..2047"},
      {"<fx:BASE-CYCLE>1<", "<fx:BASE-CYCLE>2<",
       "<fx:ABSOLUTELY-SCHEDULED-TIMING>\n                <fx:SLOT-ID>13</fx:SLOT-ID><fx:BASE",
       "BASE-CYCLE below CYCLE-REPETITION, 0..1"},
      {"FRAME-REF ID-REF=\"frame2\"", "FRAME-REF ID-REF=\"frame9\"", "<fx:FRAME-REF ID-REF=\"frame9\"",
       "FRAME-REF = frame9: must be the ID of an element of this file"},
      {"FRAME-TRIGGERING-REF ID-REF=\"ft2\"", "FRAME-TRIGGERING-REF ID-REF=\"ft9\"",
       "<fx:FRAME-TRIGGERING-REF ID-REF=\"ft9\"", "FRAME-TRIGGERING-REF = ft9: must be the ID of an element"},
      {"PDU-REF ID-REF=\"pdu1\"", "PDU-REF ID-REF=\"pdu9\"", "<fx:PDU-REF ID-REF=\"pdu9\"",
       "PDU-REF = pdu9: must be the ID of an element"},
      {"SIGNAL-REF ID-REF=\"signal1\"", "SIGNAL-REF ID-REF=\"signal9\"", "<fx:SIGNAL-REF ID-REF=\"signal9\"",
       "SIGNAL-REF = signal9: must be the ID of an element"},
      {"UNIT-REF ID-REF=\"Unit_1\"", "UNIT-REF ID-REF=\"Unit_9\"", "<ho:UNIT-REF ID-REF=\"Unit_9\"",
       "UNIT-REF = Unit_9: must be the ID of an element"},
      {"ID-REF=\"ft3\"", "ID-REF=\"ft2\"", "<fx:ECU ID=\"E2\">", "ft2: must have one sender, not ESP too"},
      {"<ho:SHORT-NAME>ESP<", "<ho:SHORT-NAME>Engine<", "<fx:ECU ID=\"E2\">", "Engine: must have a name of its own"},
      {"<fx:PDU ID=\"pdu2\">", "<fx:PDU ID=\"pdu1\">", "<fx:PDU ID=\"pdu1\"><ho:SHORT-NAME>Res",
       "pdu1: must have an ID of its own; the fx:PDU in line"},
      {"<fx:GATEWAY ID=\"G\"/>", "<fx:GATEWAY ID=\"E2A\"/>", "<fx:CONNECTOR ID=\"E2A\">",
       "E2A: must have an ID of its own; the fx:GATEWAY in line"},
      {"CHANNEL-REF ID-REF=\"A\"", "CHANNEL-REF ID-REF=\"nowhere\"", "<fx:CHANNEL-REF ID-REF=\"nowhere\"",
       "CHANNEL-REF = nowhere: must be the ID of an element of this file"},
      {"CHANNEL-REF ID-REF=\"A\"", "CHANNEL-REF ID-REF=\"E1C\"", "<fx:CHANNEL-REF ID-REF=\"E1C\"",
       "E1C: must be the ID of a fx:CHANNEL, not of the fx:CONTROLLER in line"},
      {"<fx:CHANNEL-REF ID-REF=\"A\"/>", "<fx:CHANNEL-REF/>", "<fx:CHANNEL-REF/>",
       "must have the ID-REF of a fx:CHANNEL"},
      {"CONTROLLER-REF ID-REF=\"E1C\"", "CONTROLLER-REF ID-REF=\"E3C\"", "<fx:CONTROLLER-REF ID-REF=\"E3C\"",
       "CONTROLLER-REF = E3C: must be the ID of an element"},
      {"<fx:CONNECTOR ID=\"E2A\">", "<fx:CONNECTOR ID=\"E2A\"><fx:CONTROLLER-REF ID-REF=\"E1C\"/>",
       "<fx:CONNECTOR ID=\"E2A\">", "E1C: must have a CONTROLLER-REF to a controller of its ECU"},
      {"CODING-REF ID-REF=\"coding1\"", "CODING-REF ID-REF=\"coding9\"", "<fx:CODING-REF ID-REF=\"coding9\"",
       "CODING-REF = coding9: must be the ID of an element"},
      {"<fx:GATEWAY ID=\"G\"/>", "<fx:GATEWAY ID=\"G\"><fx:ECU-REF ID-REF=\"E9\"/></fx:GATEWAY>",
       "<fx:GATEWAY ID=\"G\">", "ECU-REF = E9: must be the ID of an element"},
      {"FLEXRAY-CHANNEL-NAME>B<", "FLEXRAY-CHANNEL-NAME>A<", "<fx:CHANNEL ID=\"B\"",
       "B: must be the cluster's only channel A; A is one, too"},
      {"SAMPLE-CLOCK-PERIOD>0.012500<", "SAMPLE-CLOCK-PERIOD>abc<", "<flexray:SAMPLE-CLOCK-PERIOD>",
       "abc: must be 0.0125..0.05 us (gdSampleClockPeriod)"},
      {"<fx:SPEED>10000000</fx:SPEED>", "<fx:SPEED>10000000</fx:SPEED><fx:PROTOCOL>CAN</fx:PROTOCOL>", "<fx:SPEED>",
       "PROTOCOL = CAN: must be FlexRay"},
      {"<fx:SPEED>10000000</fx:SPEED>", "<fx:SPEED>10000000</fx:SPEED><fx:PROTOCOL-VERSION>abc</fx:PROTOCOL-VERSION>",
       "<fx:SPEED>", "abc: must be a version of the protocol, such as 2.1"},
      {"VERSION=\"3.1.0\"", "VERSION=\"5.0.0\"", "<fx:FIBEX", "5.0.0: must have a VERSION 2.x, 3.x or 4.x"},
      {"VERSION=\"3.1.0\"", "VERSION=\"3.x\"", "<fx:FIBEX", "3.x: must have a VERSION"},
      {"<flexray:MICROTICK>", "<flexray:MAX-DRIFT>abc</flexray:MAX-DRIFT><flexray:MICROTICK>", "<flexray:MICROTICK>",
       "MAX-DRIFT = abc: must be a whole number, 2..1923"},
      {"<flexray:MICROTICK>", "<flexray:MICRO-PER-MACRO-NOM>0</flexray:MICRO-PER-MACRO-NOM><flexray:MICROTICK>",
       "<flexray:MICROTICK>", "0: must be a whole number, 20..240"},
      {"<fx:BYTE-LENGTH>42<", "<fx:BYTE-LENGTH>44<", "<fx:FRAME ID=\"frame2\">",
       "44: must have a BYTE-LENGTH of at most 42"},
      {"FLEXRAY-CHANNEL-NAME>B<", "FLEXRAY-CHANNEL-NAME>C<", "<fx:CHANNEL ID=\"B\"", "A or B"},
      {"STARTUP-SYNC>1<", "STARTUP-SYNC>1024<", "<flexray:STARTUP-SYNC>", "1024: must be 1..1023"},
      {"HALT-DUE-TO-CLOCK>true<", "HALT-DUE-TO-CLOCK>yes<", "<flexray:ALLOW-HALT", "yes: must be true or false"},
      {"<ho:V>8</ho:V>", "<ho:V>eight</ho:V>", "<ho:V>eight", "eight: must be a number"},
      {"<ho:SHORT-NAME>ESP<", "<ho:SHORT-NAME>E&#10;P<", "<fx:ECU ID=\"E2\">", "E\\x0aP: must have a printable name"},
      {"xsi:type=\"flexray:CLUSTER-TYPE\"", "xsi:type=\"can:CLUSTER-TYPE\"", "<fx:ELEMENTS>", "flexray:CLUSTER-TYPE"},
  };
  for (const Mistake& mistake : mistakes) {
    const std::string text = replaced(kPowertrain, mistake.from, mistake.to);
    const std::string refusal = refusal_of(text);
    EXPECT_THAT(refusal, HasSubstr(mistake.expected)) << mistake.from;
    EXPECT_THAT(refusal, HasSubstr(fmt::format("demo.xml:{}: ", line_of(text, mistake.near)))) << mistake.from;
  }
}

// The file gives a value twice, with a contradiction.
TEST(FibexImport, AValueThatContradictsAKeptOneIsNamed) {
  struct Contradiction {
    std::string from, to, note;
  };
  const Contradiction contradictions[] = {
      {"SAMPLE-CLOCK-PERIOD>0.012500<", "SAMPLE-CLOCK-PERIOD>0.025<",
       "SAMPLE-CLOCK-PERIOD = 0.025: is left out: it is an eighth of the bit time, 0.0125"},
      {"<fx:SPEED>10000000</fx:SPEED>", "<fx:SPEED>10000000</fx:SPEED><fx:PROTOCOL-VERSION>3.0</fx:PROTOCOL-VERSION>",
       "PROTOCOL-VERSION = 3.0: is left out: the parameters are read as those of FlexRay 2.1"},
      {"<flexray:MICROTICK>",
       "<flexray:LISTEN-TIMEOUT>401202</flexray:LISTEN-TIMEOUT><flexray:MAX-DRIFT>600</"
       "flexray:MAX-DRIFT><flexray:MICROTICK>",
       "MAX-DRIFT = 600: is left out: it is pdListenTimeout / 2 - pMicroPerCycle, 601"},
      {"<flexray:MICROTICK>", "<flexray:MICRO-PER-MACRO-NOM>40</flexray:MICRO-PER-MACRO-NOM><flexray:MICROTICK>",
       "MICRO-PER-MACRO-NOM = 40: is left out: it is pMicroPerCycle / gMacroPerCycle, 50"},
  };
  const std::size_t before = parse_fibex(kPowertrain, "demo.xml").left_out.size();
  for (const Contradiction& one : contradictions) {
    const FibexImport import = parse_fibex(replaced(kPowertrain, one.from, one.to), "demo.xml");
    EXPECT_THAT(sentences(import.left_out), HasSubstr(one.note));
    EXPECT_EQ(import.left_out.size(), before + 1) << sentences(import.left_out);
  }
  // Consistent values cause no note, and fill in values that the file leaves out.
  const FibexImport drift = parse_fibex(
      replaced(kPowertrain, "<flexray:MICROTICK>", "<flexray:MAX-DRIFT>300</flexray:MAX-DRIFT><flexray:MICROTICK>"),
      "demo.xml");
  EXPECT_EQ(drift.left_out.size(), before) << sentences(drift.left_out);
  EXPECT_EQ(drift.cluster.nodes[0].flexray->pdListenTimeout, 2 * (200'000 + 300));
  EXPECT_EQ(drift.cluster.nodes[0].flexray->pRateCorrectionOut, 300);
}

// Two FlexRay clusters in one file: the second one's channels, connectors and ECUs stay out of the first.
TEST(FibexImport, TheChannelsAreThoseTheClusterRefersTo) {
  const std::string one =
      replaced(replaced(kPowertrain, "<fx:SPEED>10000000</fx:SPEED>",
                        "<fx:SPEED>10000000</fx:SPEED><fx:CHANNEL-REFS><fx:CHANNEL-REF ID-REF=\"A\"/>"
                        "<fx:CHANNEL-REF ID-REF=\"B\"/></fx:CHANNEL-REFS>"),
               "</fx:CHANNELS>",
               "<fx:CHANNEL ID=\"X\" xsi:type=\"flexray:CHANNEL-TYPE\">"
               "<flexray:FLEXRAY-CHANNEL-NAME>A</flexray:FLEXRAY-CHANNEL-NAME></fx:CHANNEL></fx:CHANNELS>");
  const std::string two = replaced(one, "<fx:CONNECTORS>",
                                   "<fx:CONNECTORS><fx:CONNECTOR ID=\"E1X\">"
                                   "<fx:CHANNEL-REF ID-REF=\"X\"/><fx:CONTROLLER-REF ID-REF=\"E1C\"/></fx:CONNECTOR>");
  const FibexImport import = parse_fibex(two, "demo.xml");
  EXPECT_EQ(FibexDifference::of(import.cluster, parse_fibex(kPowertrain, "demo.xml").cluster), "");
  EXPECT_THAT(sentences(import.left_out), HasSubstr("X: is not a channel of the first FlexRay cluster"));
  EXPECT_THAT(sentences(import.left_out), HasSubstr("X: is on no channel of the first FlexRay cluster"));
}

// A node cannot send where it is not attached, and no exported file could say that it does.
TEST(FibexImport, AFrameOnAChannelWithoutItsSenderIsLeftOut) {
  const std::string apart =
      replaced(kPowertrain, "<fx:CONNECTOR ID=\"E2A\">", "<fx:CONNECTOR ID=\"E2A\"><fx:CHANNEL-REF ID-REF=\"B\"/>");
  const FibexImport import = parse_fibex(apart, "demo.xml");
  EXPECT_EQ(import.cluster.nodes[1].flexray->pChannels, model::Channels::kB);
  EXPECT_THAT(sentences(import.left_out),
              HasSubstr("FRAME-TRIGGERING = ft1: is left out: its sender has no connector to its channel"));
  ASSERT_EQ(import.cluster.frames.size(), 3u) << "slots 1 and 13, and 61 of the dynamic segment";
  EXPECT_EQ(import.cluster.frames[1].slot, 13);
  EXPECT_EQ(import.cluster.frames[1].channels, model::Channels::kB);
}

// An ID is required. A connector without a channel is not on a channel that lacks its ID.
TEST(FibexImport, AMissingReferenceIsNoReferenceToAMissingId) {
  const std::string without = replaced(kPowertrain, "<fx:CHANNEL ID=\"B\"", "<fx:CHANNEL");
  EXPECT_EQ(parse_fibex(without, "demo.xml").cluster.nodes[1].flexray->pChannels, model::Channels::kAB);
}

TEST(FibexImport, DamagedXmlIsRefusedInOneSentenceWithItsLine) {
  const std::string text = kPowertrain;
  const int lines = static_cast<int>(std::count(text.begin(), text.end(), '\n'));
  const std::pair<std::string, std::string> damages[] = {
      {replaced(text, "</fx:GATEWAYS>", "</fx:GATEWAY>"),
       fmt::format("demo.xml:{}: is not well-formed XML: ", line_of(text, "</fx:GATEWAYS>"))},
      {text + "<fx:FIBEX/>", fmt::format("demo.xml:{}: is not well-formed XML: a second root element", lines + 1)},
      {text + "more", fmt::format("demo.xml:{}: is not well-formed XML: text outside", lines + 1)},
      {replaced(text, "<fx:FIBEX", "<!DOCTYPE FIBEX [<!ENTITY a \"b\">]>\n<fx:FIBEX"),
       "demo.xml:2: has a document type"},
      {replaced(text, "Powertrain", std::string("Power\0train", 11)),
       fmt::format("demo.xml:{}: is not XML in UTF-8", line_of(text, "Powertrain"))},
      {replaced(text, "Powertrain", "Power\xfftrain"),
       fmt::format("demo.xml:{}: is not XML in UTF-8", line_of(text, "Powertrain"))},
      {"", "demo.xml:1: is no"},
      {"name: a\n", "demo.xml:1: is no"},
      {"<a/>", "demo.xml:1: a: must be fx:FIBEX"},
  };
  for (const auto& [damaged, expected] : damages) {
    const std::string refusal = refusal_of(damaged);
    EXPECT_THAT(refusal, testing::StartsWith(expected));
    EXPECT_EQ(std::count(refusal.begin(), refusal.end(), '\n'), 0) << refusal;
  }
  // Cut anywhere before its end.
  const std::size_t end = text.rfind('>');
  for (std::size_t size = 0; size < end; size += 97) EXPECT_NE(refusal_of(text.substr(0, size)), "") << size;
  EXPECT_EQ(refusal_of(text.substr(0, end + 1)), "");
  EXPECT_THROW(import_fibex("/nothing.xml"), InputError);
}

// The same unknown element a hundred times is one note.
TEST(FibexImport, AnElementLeftOutOftenIsNamedOnce) {
  std::string text = kPowertrain;
  for (int i = 0; i < 100; ++i) text = replaced(text, "<fx:GATEWAYS>", "<fx:LINKS/>\n<fx:GATEWAYS>");
  const FibexImport import = parse_fibex(text, "demo.xml");
  const auto links = std::count_if(import.left_out.begin(), import.left_out.end(), [](const Finding& finding) {
    return finding.key == "fx:FIBEX/fx:ELEMENTS/fx:LINKS" && finding.expected.find("(100 times)") != std::string::npos;
  });
  EXPECT_EQ(links, 1) << sentences(import.left_out);
}

// Names that YAML would misread, or that contain its signs.
TEST(FibexImport, AnyPrintableNameSurvivesTheClusterFile) {
  for (const char* name :
       {"null", "true", "12", "- a", "a: b", "a \"quoted\" \\name", "#a", "äöü", "{x}", "'", "~", "yes"}) {
    model::Cluster cluster = check::load_checked_cluster(shipped_path("paper_synchronised"));
    cluster.name = name;
    cluster.nodes.back().name = name;
    cluster.pdus.back().name = name;
    cluster.pdus.back().element.back().name = name;
    cluster.pdus.back().element.back().unit = name;
    const FibexImport import = parse_fibex(fibex_text(cluster), "cluster.xml");
    EXPECT_EQ(FibexDifference::of(cluster, file::parse_cluster(skeleton_yaml(import), "cluster.yaml")), "") << name;
  }
}

}  // namespace
}  // namespace ttf::schedules::exchange::fibex
