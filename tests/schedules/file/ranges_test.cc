// The ranges of FlexRay Protocol Specification 2.1 Rev. A, annex B, written a second time and compared with
// the loader. Both ends are accepted, one beyond either end is refused.
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/schedules/cluster_file.h"
#include "tests/support/patterns.h"

namespace ttf::schedules::file {
namespace {

struct AnnexB {
  const char* name;
  int low, high;
};

constexpr AnnexB kRanges[] = {
    {"gColdStartAttempts", 2, 31},
    {"gListenNoise", 2, 16},
    {"gMacroPerCycle", 10, 16000},
    {"gdActionPointOffset", 1, 63},
    {"gdStaticSlot", 4, 661},
    {"gNumberOfStaticSlots", 2, 1023},
    {"gPayloadLengthStatic", 0, 127},
    {"gdMinislot", 2, 63},
    {"gNumberOfMinislots", 0, 7986},
    {"gdMinislotActionPointOffset", 1, 31},
    {"gdDynamicSlotIdlePhase", 0, 2},
    {"gdSymbolWindow", 0, 142},
    {"gdNIT", 2, 805},
    {"gOffsetCorrectionStart", 9, 15999},
    {"gSyncNodeMax", 2, 15},
    {"gMaxWithoutClockCorrectionPassive", 1, 15},
    {"gMaxWithoutClockCorrectionFatal", 1, 15},
    {"gCycleCountMax", 7, 63},  // of 3.0.1; 63 in 2.1
    {"gNetworkManagementVectorLength", 0, 12},
    {"gdTSSTransmitter", 3, 15},
    {"gdCASRxLowMax", 67, 99},
    {"gdWakeupSymbolTxLow", 15, 60},
    {"gdWakeupSymbolTxIdle", 45, 180},
    {"gdWakeupSymbolRxIdle", 14, 59},
    {"gdWakeupSymbolRxLow", 11, 59},
    {"gdWakeupSymbolRxWindow", 76, 301},
    {"gClusterDriftDamping", 0, 5},
    {"gdCycle", 10, 16000},
    {"gdMacrotick", 1, 6},
    {"pClusterDriftDamping", 0, 20},
    {"pMicroPerCycle", 640, 640000},
    {"pOffsetCorrectionOut", 5, 15266},
    {"pRateCorrectionOut", 2, 1923},
    {"pdAcceptedStartupRange", 0, 1875},
    {"pdListenTimeout", 1284, 1283846},
    {"pMacroInitialOffsetA", 2, 72},
    {"pMacroInitialOffsetB", 2, 72},
    {"pMicroInitialOffsetA", 0, 240},
    {"pMicroInitialOffsetB", 0, 240},
    {"pDecodingCorrection", 14, 143},
    {"pDelayCompensationA", 0, 200},
    {"pDelayCompensationB", 0, 200},
    {"pKeySlotId", 1, 1023},
    {"pLatestTx", 0, 7980},
    {"pAllowPassiveToActive", 0, 31},
    {"pWakeupPattern", 2, 63},
};

// The loader's refusal (not the checker's) of the parameter with this value.
std::string refusal(const std::string& name, int value) {
  static const std::string kShipped = shipped_text("paper_unsynchronised");
  const std::string text =
      support::replaced_first(kShipped, "\\b" + name + ": [0-9.]+", name + ": " + std::to_string(value));
  try {
    parse_cluster(text, "cluster.yaml");
  } catch (const InputError& error) {
    for (const Finding& finding : error.findings())
      if (finding.key.ends_with("." + name) && finding.value == std::to_string(value)) return finding.expected;
  }
  return "";
}

TEST(Ranges, AreThoseOfAnnexB) {
  for (const AnnexB& range : kRanges) {
    SCOPED_TRACE(range.name);
    const std::string text = std::to_string(range.low) + ".." + std::to_string(range.high);
    EXPECT_EQ(refusal(range.name, range.low), "");
    EXPECT_EQ(refusal(range.name, range.high), "");
    EXPECT_NE(refusal(range.name, range.low - 1).find(text), std::string::npos) << refusal(range.name, range.low - 1);
    EXPECT_NE(refusal(range.name, range.high + 1).find(text), std::string::npos) << refusal(range.name, range.high + 1);
  }
}

// Every parameter of the shipped files is in the table above or has its own rule.
TEST(Ranges, CoverEveryNumberOfTheFile) {
  const std::vector<std::string> own_rules{
      "gdBit",          "baudrate",    "gdMaxPropagationDelay", "gdMinPropagationDelay",
      "gdMaxMicrotick", "pdMicrotick", "pSamplesPerMicrotick"};
  const std::string text = shipped_text("paper_unsynchronised");
  const auto parameters = support::matches(text, "\\n  ([gp]d?[A-Z][A-Za-z]+|baudrate): [0-9]");
  for (const support::Match& parameter : parameters) {
    const std::string& name = parameter[1];
    const bool listed =
        std::any_of(std::begin(kRanges), std::end(kRanges), [&](const AnnexB& r) { return name == r.name; });
    EXPECT_NE(listed, std::count(own_rules.begin(), own_rules.end(), name) == 1) << name;
  }
  EXPECT_EQ(parameters.size(), 52U);  // pKeySlotId stands with the nodes
}

}  // namespace
}  // namespace ttf::schedules::file
