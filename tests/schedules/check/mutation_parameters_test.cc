#include <gtest/gtest.h>

#include "tests/schedules/check/mutation.h"
#include "tests/support/patterns.h"

namespace ttf::schedules::check {
namespace {

// Given once, for the cluster or for all nodes; the finding prints `printed`, in its unit.
Mutation parameter(const std::string& name, const std::string& value, const std::string& key, const std::string& words,
                   const std::string& printed) {
  return {name,
          "\\b" + name + ": [0-9.]+",
          name + ": " + value,
          {name + ": " + value, key + "." + name, printed.empty() ? value : printed, words}};
}
Mutation global_parameter(const std::string& name, const std::string& value, const std::string& words,
                          const std::string& printed = "") {
  return parameter(name, value, "flexray", words, printed);
}
Mutation node_parameter(const std::string& name, const std::string& value, const std::string& words,
                        const std::string& printed = "") {
  return parameter(name, value, "nodes.laser_pre.flexray", words, printed);
}

TEST(Mutations, OfParameters) {
  expect_named({
      global_parameter("gColdStartAttempts", "32", "2..31"),
      global_parameter("gdNIT", "900", "2..805 macroticks"),
      global_parameter("gCycleCountMax", "64", "7..63"),
      global_parameter("gCycleCountMax", "62", "must be odd"),
      global_parameter("gdTSSTransmitter", "16", "3..15 gdBit"),
      {"pWakeupPattern",
       "\\bpWakeupPattern: [0-9.]+",
       "pWakeupPattern: 64",
       {"pWakeupPattern: 64", "node_parameters.pWakeupPattern", "64", "2..63"}},
      global_parameter("gSyncNodeMax", "4", "nodes with pKeySlotUsedForSync, 5"),
      global_parameter("gdCycle", "6000", "gMacroPerCycle * gdMacrotick", "6000 us"),
      global_parameter("baudrate", "5000000", "1 / gdBit"),
      global_parameter("gdActionPointOffset", "6", "at least 7 macroticks"),
      global_parameter("gdStaticSlot", "83", "at least 84 macroticks"),
      global_parameter("gdSymbolWindow", "5", "constraint 16"),
      global_parameter("gOffsetCorrectionStart", "4500", "network idle time, 4614..4999"),
      global_parameter("gdMinPropagationDelay", "2.6", "0..2.5 us"),
      global_parameter("gdMinislotActionPointOffset", "5", "below gdMinislot"),
      global_parameter("gMaxWithoutClockCorrectionFatal", "1", "gMaxWithoutClockCorrectionPassive"),
      global_parameter("gdMacrotick", "1.0000001", "in steps of"),
      global_parameter("gNumberOfMinislots", "2040", "frame ids end at 2047"),
      {"constraint_18",
       "\\bgdNIT: 386",
       "gdNIT: 385",
       {"gMacroPerCycle: 5000", "flexray.gMacroPerCycle", "5000", "constraint 18"}},
      node_parameter("pMicroPerCycle", "199999", "gdCycle"),
      node_parameter("pSamplesPerMicrotick", "4", "pdMicrotick"),
      node_parameter("pRateCorrectionOut", "600", "at least 601"),
      node_parameter("pOffsetCorrectionOut", "200", "assumed precision"),
      node_parameter("pClusterDriftDamping", "3", "gClusterDriftDamping"),
      node_parameter("pLatestTx", "300", "gNumberOfMinislots"),
      node_parameter("pKeySlotId", "40", "owns on both channels in every cycle"),
      {"guardian_without_a_star",
       "\nsynchronisation: true",
       "\nsynchronisation: true\nguardian: true",
       {"guardian: true", "guardian", "true", "needs topology: star"}},
      {"guardian_on_a_bus",
       "\nsynchronisation: true",
       "\nsynchronisation: true\ntopology: bus\nguardian: true",
       {"guardian: true", "guardian", "true", "needs topology: star"}},
      {"topology",
       "\nsynchronisation: true",
       "\nsynchronisation: true\ntopology: ring",
       {"topology: ring", "topology", "ring", "bus, star"}},
      {"startup_without_sync",
       "pKeySlotUsedForSync: true",
       "pKeySlotUsedForSync: false",
       {"pKeySlotUsedForStartup: true", "nodes.laser_pre.flexray.pKeySlotUsedForStartup", "true",
        "needs pKeySlotUsedForSync"}},
      {"no_sync_nodes",
       "pKeySlotUsedForSync: true",
       "pKeySlotUsedForSync: false",
       {"gSyncNodeMax: 5", "flexray.gSyncNodeMax", "5", "at least 2"}},
      {"propagation_order",
       "gdMaxPropagationDelay: 2.5(.*\n.*gdMinPropagationDelay: )0",
       "gdMaxPropagationDelay: 1$011.5",
       {"gdMinPropagationDelay: 1.5", "flexray.gdMinPropagationDelay", "1.5 us",
        "at most gdMaxPropagationDelay = 1 us"}},
      {"microtick_too_long",
       "gdMaxMicrotick: 25",
       "gdMaxMicrotick: 12.5",
       {"pdMicrotick: 25", "nodes.laser_pre.flexray.pdMicrotick", "25 ns", "at most gdMaxMicrotick = 12.5 ns"}},
      {"bit_rate",
       "gdBit: 0.1(.*\n.*baudrate: )10000000",
       "gdBit: 0.25$014000000",
       {"gdBit: 0.25", "flexray.gdBit", "0.25 us", "one of 0.1, 0.2, 0.4 us"}},
      node_parameter("pdMicrotick", "37.5", "one of 12.5, 25, 50 ns", "37.5 ns"),
      node_parameter("pSamplesPerMicrotick", "3", "one of 1, 2, 4"),
      node_parameter("pOffsetCorrectionOut", "3888", "274..3887 microticks"),
      {"single_slot",
       "pKeySlotOnlyEnabled: false",
       "pKeySlotOnlyEnabled: true",
       {"pKeySlotOnlyEnabled: true", "nodes.gateway.flexray.pKeySlotOnlyEnabled", "true",
        "must be false: gateway also has slot 6 (line 283)"}},
      {"drift",
       inside("gateway", "max_drift_ppm") + "1500",
       "$01100\n    drift_ppm: -200",
       {"drift_ppm: -200", "nodes.gateway.drift_ppm", "-200", "max_drift_ppm = 100"}},
      {"startup_nodes",
       "pKeySlotUsedForStartup: true",
       "pKeySlotUsedForStartup: false",
       {"laser:", "nodes", "0", "at least 3 nodes"}},
  });
}

TEST(Mutations, OneControllerIsNoCluster) {
  const std::string text =
      support::replaced(shipped_text("paper_unsynchronised"), "flexray: \\{pKeySlotId: [2-5]\\}", "microtick: 25");
  const auto findings = findings_of(text);
  const auto found = std::find_if(findings.begin(), findings.end(), [](const Finding& f) { return f.key == "nodes"; });
  ASSERT_NE(found, findings.end()) << sentences(findings);
  EXPECT_EQ(found->value, "1");
  EXPECT_EQ(found->expected, "must have at least 2 nodes on FlexRay");
  EXPECT_GT(found->line, 0);
}

}  // namespace
}  // namespace ttf::schedules::check
