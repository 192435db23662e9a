// Every rule has a mistake here that breaks it: one change to a shipped file, and the sentence it must lead to.
#include <gtest/gtest.h>

#include <algorithm>
#include <regex>

#include "tests/schedules/cluster_file.h"

namespace ttf::schedules {
namespace {

struct Mutation {
  std::string name;
  std::string pattern;        // its first match in paper_unsynchronised.yaml ...
  std::string replacement;    // ... becomes this
  std::string key;            // some finding's key contains this,
  std::string words;          // and what it expects contains this
};

Mutation parameter(const std::string& name, const std::string& value, const std::string& words) {
  return {name, "\\b" + name + ": [0-9.]+", name + ": " + value, name, words};
}

// The header of a node or task, up to a key inside it.
std::string inside(const std::string& outer, const std::string& key) {
  return "(\n *" + outer + ":[^~]*?" + key + ": )";
}

std::vector<Mutation> mutations() {
  return {
      // Ranges of the specification, and each constraint between parameters.
      parameter("gColdStartAttempts", "32", "2..31"),
      parameter("gdNIT", "900", "2..805 macroticks"),
      parameter("gCycleCountMax", "31", "63..63"),
      parameter("gdTSSTransmitter", "16", "3..15 gdBit"),
      parameter("pWakeupPattern", "64", "2..63"),
      parameter("gSyncNodeMax", "4", "there are 5"),
      parameter("gdCycle", "6000", "gMacroPerCycle * gdMacrotick"),
      parameter("baudrate", "5000000", "1 / gdBit"),
      parameter("gdActionPointOffset", "6", "at least 7 macroticks"),
      parameter("gdStaticSlot", "83", "at least 84 macroticks"),
      parameter("gdSymbolWindow", "5", "constraint 16"),
      parameter("gOffsetCorrectionStart", "4500", "network idle time, 4614..4999"),
      parameter("gdMinPropagationDelay", "2.6", "0..2.5 us"),
      parameter("gdMinislotActionPointOffset", "5", "below gdMinislot"),
      parameter("gMaxWithoutClockCorrectionFatal", "1", "gMaxWithoutClockCorrectionPassive"),
      parameter("gdMacrotick", "1.0000001", "in steps of"),
      parameter("gNumberOfMinislots", "2040", "frame ids end at 2047"),
      {"constraint_18", "\\bgdNIT: 386", "gdNIT: 385", "gMacroPerCycle", "constraint 18"},
      parameter("pMicroPerCycle", "199999", "gdCycle"),
      parameter("pSamplesPerMicrotick", "4", "pdMicrotick"),
      parameter("pRateCorrectionOut", "600", "at least 601"),
      parameter("pOffsetCorrectionOut", "200", "assumed precision"),
      parameter("pClusterDriftDamping", "3", "gClusterDriftDamping"),
      parameter("pLatestTx", "300", "gNumberOfMinislots"),
      parameter("pKeySlotId", "40", "owns on both channels in every cycle"),
      {"startup_without_sync", "pKeySlotUsedForSync: true", "pKeySlotUsedForSync: false", "pKeySlotUsedForStartup",
       "needs pKeySlotUsedForSync"},
      {"no_sync_nodes", "pKeySlotUsedForSync: true", "pKeySlotUsedForSync: false", "gSyncNodeMax", "at least 2"},
      // Slots.
      {"slot_owned_twice", "slot: 6,", "slot: 5,", "slot 5", "owned twice"},
      {"slot_beyond", "slot: 22,", "slot: 32,", "slot 41", "1..40"},
      {"repetition", "repetition: 8, pdu: image", "repetition: 6, pdu: image", "repetition", "1, 2, 4, 8, 16, 32, 64"},
      {"base_cycle", "base_cycle: [0-9], repetition: 8, pdu: image", "base_cycle: 8, repetition: 8, pdu: image",
       "base_cycle", "0..7"},
      {"fragment_without_slot", "pdu: image, fragments: 13", "pdu: image, fragments: 12", "frames.image",
       "fragment 12 has none"},
      {"fragments_beyond", "pdu: image, fragments: 13", "pdu: image, fragments: 1010", "fragments",
       "at most 1002: static slots end at 1023"},
      {"fragment_too_many", "pdu: image, fragments: 13", "pdu: image, fragments: 14", "slot 35", "0..12"},
      {"payload", "gPayloadLengthStatic: 28", "gPayloadLengthStatic: 27", "slot 6", "54 bytes"},
      {"sender_off_flexray", "(slot: 5, channels: AB, sender: )feature", "$01camera", "slot 5", "FlexRay controller"},
      {"slots_of_another", "(slot: 22, channels: AB, sender: )fusion", "$01gateway", "publish.writes.image",
       "slots that fusion owns"},
      // PDUs.
      {"pdu_too_long", "(image:\\s+fragment_bytes: )56", "$0148", "pdus.image.fragment_bytes", "at least 56"},
      {"pdu_without_sequence", "\\{name: sequence, bits: 16\\}", "{name: sequel, bits: 16}", "header", "sequence"},
      {"pdu_count_bits", "\\{name: count, bits: 16\\}", "{name: count, bits: 10}", "header", "enough bits for 1300"},
      {"signal_range", "high: 200,", "high: 2000,", "high", "does not fit 16 bits"},
      // CAN.
      {"can_identifier", "(pdu: camera_objects, identifier: )[0-9]+(.*)",
       "$01999$2\n      - {pdu: laser_scan, identifier: 999, sender: laser, shortest_period: 79 ms}",
       "messages.laser_scan", "unique"},
      {"can_length", inside("laser_can", "flexible_data_rate") + "true\n.*\n.*data_bit_rate.*",
       "$01false\n    nominal_bit_rate: 1000000", "messages.laser_scan", "at most 8 bytes"},
      {"can_load", inside("laser_can", "other_load") + "0.0", "$010.7", "can.laser_can", "at most 80 %"},
      {"can_period", "(pdu: laser_scan.*shortest_period: )[0-9]+ ms", "$01200 ms", "messages.laser_scan",
       "period of the sensor"},
      {"can_sender", "(pdu: laser_scan.*sender: )laser", "$01camera", "measure.writes.raw", "a message that laser sends"},
      // Tasks.
      {"deadline", inside("publish", "deadline") + "[0-9]+ [a-z]+", "$01100 us", "publish.worst_case", "the deadline"},
      {"execution_order", inside("publish", "best_case") + "[0-9]+ [a-z]+", "$0130 ms", "publish.worst_case",
       "below best_case"},
      {"overlap", inside("publish", "base_cycle") + "[0-9], repetition: 8, offset: [0-9]+",
       "$010, repetition: 1, offset: 1801", "publish.activation", "overlaps fuse"},
      {"self_overlap", inside("use", "worst_case") + "[0-9]+ [a-z]+", "$0150 ms", "use.worst_case", "overlaps itself"},
      {"message_port", inside("laser_pre", "port") + "raw", "$01cooked", "activation.port", "ports the task reads"},
      {"too_slow_for_messages", inside("camera_pre", "worst_case") + "[0-9]+ [a-z]+", "$0160 ms",
       "camera_pre.tasks.preprocess.worst_case", "shortest period of camera_frame"},
      {"time_off_flexray", inside("laser", "activation") + "\\{kind: sensor, sensor: laser\\}",
       "$01{kind: time, base_cycle: 0, repetition: 16, offset: 0}", "laser.tasks.measure.activation", "FlexRay"},
      {"completion_of_nothing", inside("publish", "activation") + "\\{[^}]*\\}", "$01{kind: completion, after: nobody}",
       "activation.after", "lead back to a task"},
      {"completion_of_itself", inside("publish", "activation") + "\\{[^}]*\\}", "$01{kind: completion, after: publish}",
       "activation.after", "lead back to a task"},
      // Flow.
      {"read_but_not_written", "(camera: )camera_objects on flexray", "$01laser_scan on flexray", "reads.camera",
       "no task writes it"},
      {"written_but_not_read", ", camera: camera_objects on flexray", "", "writes.out", "no task reads it"},
      {"written_twice", inside("forward_camera", "out") + "camera_objects", "$01laser_objects", "writes.out",
       "has a writer already"},
      {"port_bound_twice", inside("forward_laser", "writes") + "\\{out", "$01{in", "forward_laser", "bound twice"},
      {"binding_nonsense", "laser_objects on flexray", "laser_objects at flexray", "forward_laser", "PDU on flexray"},
      {"sensor_without_task", inside("camera", "sensor") + "camera\\}", "$01laser}", "sensors.camera.device",
       "exactly one task"},
      {"task_of_another_device", inside("camera", "sensor") + "camera\\}", "$01laser}", "camera.tasks.measure",
       "whose device is camera"},
      {"host_does_not_read", "host: camera_pre", "host: feature", "sensors.camera.host", "must read a PDU"},
      {"host_off_flexray", "host: camera_pre", "host: laser", "sensors.camera.host", "on FlexRay"},
      // Names.
      {"no_such_node", "host: camera_pre", "host: camera_post", "host", "name of a node"},
      {"no_such_pdu", "pdu: image, fragments", "pdu: picture, fragments", "pdu", "name of a PDU"},
      {"unknown_key", "gListenNoise: 2", "gListenNoise: 2\n  gListenQuiet: 2", "gListenQuiet", "not a known key"},
      {"duplicate_key", "gListenNoise: 2", "gListenNoise: 2\n  gListenNoise: 3", "gListenNoise", "given twice"},
      {"missing_key", "  gListenNoise: 2.*\n", "", "gListenNoise", "is missing"},
      {"missing_shared_key", "  pAllowHaltDueToClock: .*\n", "", "pAllowHaltDueToClock", "is missing"},
      {"not_a_number", "gdNIT: 386", "gdNIT: long", "gdNIT", "2..805"},
  };
}

TEST(Mutations, EachRuleNamesItsMistake) {
  const std::string original = shipped_text("paper_unsynchronised");
  ASSERT_TRUE(findings_of(original).empty()) << sentences(findings_of(original));
  for (const Mutation& mutation : mutations()) {
    SCOPED_TRACE(mutation.name);
    const std::string text = std::regex_replace(original, std::regex(mutation.pattern), mutation.replacement,
                                                std::regex_constants::format_first_only);
    ASSERT_NE(text, original) << "the pattern does not occur in the file";
    const auto findings = findings_of(text);
    const bool named = std::any_of(findings.begin(), findings.end(), [&](const Finding& finding) {
      return finding.key.find(mutation.key) != std::string::npos &&
             finding.expected.find(mutation.words) != std::string::npos && finding.file == "cluster.yaml" &&
             (finding.line > 0 || finding.key == "nodes");
    });
    EXPECT_TRUE(named) << "wanted " << mutation.key << ": " << mutation.words << sentences(findings);
  }
}

TEST(Mutations, AMistakeInTheSharedParametersIsReportedOnce) {
  const std::string text = std::regex_replace(shipped_text("paper_unsynchronised"), std::regex("pWakeupPattern: 2"),
                                              "pWakeupPattern: 99");
  EXPECT_EQ(findings_of(text).size(), 1u) << sentences(findings_of(text));
}

TEST(Mutations, ASlotWithManyOwnersIsSaidOncePerFrameTooMany) {
  const std::string text = std::regex_replace(shipped_text("paper_unsynchronised"), std::regex("(slot: )[2-5],"),
                                              "$011,");
  const auto findings = findings_of(text);
  EXPECT_EQ(std::count_if(findings.begin(), findings.end(),
                          [](const Finding& f) { return f.expected.find("owned twice") != std::string::npos; }),
            4)
      << sentences(findings);
}

TEST(Mutations, AllMistakesAreReportedAtOnce) {
  std::string text = shipped_text("paper_unsynchronised");
  for (const char* key : {"gListenNoise", "gColdStartAttempts", "gdCASRxLowMax"})
    text = std::regex_replace(text, std::regex(std::string(key) + ": [0-9]+"), std::string(key) + ": 1000");
  EXPECT_EQ(findings_of(text).size(), 3u) << sentences(findings_of(text));
}

TEST(Mutations, LinesAreThoseOfTheParameter) {
  std::string text = shipped_text("paper_unsynchronised");
  const auto at = text.find("gdStaticSlot: 84");
  ASSERT_NE(at, std::string::npos);
  const auto line = 1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n');
  text.replace(at, 16, "gdStaticSlot: 83");
  const auto findings = findings_of(text);
  const auto found = std::find_if(findings.begin(), findings.end(),
                                  [](const Finding& f) { return f.key == "flexray.gdStaticSlot"; });
  ASSERT_NE(found, findings.end());
  EXPECT_EQ(found->line, line);
}

TEST(Mutations, ATruncatedFileIsNeverAccepted) {
  const std::string text = shipped_text("paper_unsynchronised");
  // A cut may leave valid YAML, but never a whole cluster, except behind its last line's end.
  for (std::size_t length = 0; length + 40 < text.size(); length += 97)
    EXPECT_FALSE(findings_of(text.substr(0, length)).empty()) << "cut after " << length << " bytes";
}

TEST(Mutations, AnUnreadableFileIsOneFinding) {
  try {
    load_cluster(shipped_path("no_such_cluster"));
    FAIL() << "loaded what does not exist";
  } catch (const InputError& error) {
    ASSERT_EQ(error.findings().size(), 1u);
    EXPECT_NE(error.findings()[0].sentence().find("no_such_cluster"), std::string::npos);
  }
}

}  // namespace
}  // namespace ttf::schedules
