#include "schedules/file/derive.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <sstream>

#include "tests/schedules/cluster_dump.h"
#include "tests/schedules/cluster_file.h"
#include "tests/support/patterns.h"

namespace ttf::schedules::file {
namespace {

std::string derived_in(const model::Cluster& cluster, const std::string& path) {
  for (const model::DerivedValue& one : cluster.derived)
    if (one.path == path) return one.value;
  return "not derived";
}

// The shipped file without these parameters, wherever they stand.
std::string paper_without(const std::vector<std::string>& parameters) {
  std::string text = shipped_text("paper_synchronised");
  for (const std::string& name : parameters) {
    const std::string before = text;
    text = support::replaced(text, "\n  " + name + ": [^\n]*", "");
    EXPECT_NE(text, before) << name;
  }
  return text;
}

// The file says these as the rules do, so that the cluster is the same without them.
TEST(Derive, ThePapersClusterNeedsNoneOfThese) {
  const std::vector<std::string> left_out{"gMacroPerCycle",
                                          "baudrate",
                                          "gdActionPointOffset",
                                          "gdStaticSlot",
                                          "gdNIT",
                                          "gCycleCountMax",
                                          "gdWakeupSymbolTxLow",
                                          "gdWakeupSymbolTxIdle",
                                          "gdWakeupSymbolRxIdle",
                                          "gdWakeupSymbolRxWindow",
                                          "pSamplesPerMicrotick",
                                          "pMicroPerCycle",
                                          "pRateCorrectionOut",
                                          "pdListenTimeout",
                                          "pDelayCompensationA",
                                          "pDelayCompensationB"};
  std::string text = paper_without(left_out);
  text = support::replaced(text, "flexray: \\{pKeySlotId: [0-9]\\}", "flexray: {}");
  const model::Cluster cluster = parse_cluster(text, "cluster.yaml");
  EXPECT_EQ(dump(cluster), dump(load_cluster(shipped_path("paper_synchronised"))));
  EXPECT_TRUE(check::check(cluster).empty());
  // Shared by all nodes, and each node's own.
  EXPECT_EQ(derived_in(cluster, "flexray.gdNIT"), "386");
  EXPECT_EQ(derived_in(cluster, "node_parameters.pRateCorrectionOut"), "601");
  EXPECT_EQ(derived_in(cluster, "nodes.gateway.flexray.pKeySlotId"), "3");
  EXPECT_EQ(cluster.derived.size(), left_out.size() + 5);
}

// Bounds are derived as the checker has them: the cluster passes, and one less (one more) fails.
TEST(Derive, BoundsAreTight) {
  const std::map<std::string, int> beyond{{"gdCASRxLowMax", -1},        {"gdWakeupSymbolRxWindow", -1},
                                          {"gdActionPointOffset", -1},  {"pRateCorrectionOut", -1},
                                          {"pOffsetCorrectionOut", -1}, {"pdAcceptedStartupRange", -1},
                                          {"gdWakeupSymbolRxIdle", 1},  {"gOffsetCorrectionStart", -1}};
  for (const auto& [name, step] : beyond) {
    SCOPED_TRACE(name);
    const bool global = name[0] == 'g';
    const std::string path = (global ? "flexray." : "node_parameters.") + name;
    // The listen timeout follows the rate correction.
    const std::string text =
        name == "pRateCorrectionOut" ? paper_without({name, "pdListenTimeout"}) : paper_without({name});
    const model::Cluster cluster = parse_cluster(text, "cluster.yaml");
    EXPECT_TRUE(check::check(cluster).empty()) << sentences(check::check(cluster));
    const int value = std::stoi(derived_in(cluster, path));
    const std::string section = global ? "\nflexray:\n" : "\nnode_parameters:\n";
    std::string wrong = text;
    wrong.insert(wrong.find(section) + section.size(), "  " + name + ": " + std::to_string(value + step) + "\n");
    const auto findings = findings_of(wrong);
    EXPECT_TRUE(std::any_of(findings.begin(), findings.end(),
                            [&, parameter = name](const Finding& one) { return one.key.ends_with(parameter); }))
        << value << sentences(findings);
  }
}

// The specification's equations, worked out by hand for the paper's cluster: 10 Mbit/s, microticks of 25 ns,
// macroticks of 1 us, a TSS of 9 bits.
TEST(Derive, EquationsByHand) {
  const std::string text =
      paper_without({"gdCASRxLowMax", "gOffsetCorrectionStart", "pOffsetCorrectionOut", "pDecodingCorrection",
                     "pdAcceptedStartupRange", "pMacroInitialOffsetA", "pMacroInitialOffsetB", "pMicroInitialOffsetA",
                     "pMicroInitialOffsetB", "pLatestTx", "gdMinislot", "gdMinislotActionPointOffset",
                     "gdDynamicSlotIdlePhase", "gdNIT"});
  const model::Cluster cluster =
      parse_cluster(support::replaced(text, "gNumberOfMinislots: 250", "gNumberOfMinislots: 60"), "cluster.yaml");
  EXPECT_TRUE(check::check(cluster).empty()) << sentences(check::check(cluster));
  const model::GlobalParameters& g = cluster.flexray;
  EXPECT_EQ(g.gdCASRxLowMax, 79);               // 2 (9 + 30) 1.0015 / 0.9985 = 78.23
  EXPECT_EQ(g.gdMinislotActionPointOffset, 7);  // 6.85 us / 0.9985 = 6.86
  EXPECT_EQ(g.gdMinislot, 17);                  // 7 + (6.85 + 2.5) us / 0.9985 = 16.36
  EXPECT_EQ(g.gdDynamicSlotIdlePhase, 1);       // 1.10 + 6.85 + 2.5 us = 10.45, 9.985 of them in the minislot
  EXPECT_EQ(g.gdNIT, 620);                      // 5000 - 40 * 84 - 0 - 60 * 17
  EXPECT_EQ(g.gOffsetCorrectionStart, 4380);    // 5000 - 620
  for (const model::Node& node : cluster.nodes) {
    if (!node.flexray) continue;
    const model::NodeParameters& p = *node.flexray;
    EXPECT_EQ(p.pOffsetCorrectionOut, 274);    // 6.85 us / 25 ns
    EXPECT_EQ(p.pdAcceptedStartupRange, 275);  // 274 / 0.9985 = 274.4
    EXPECT_EQ(p.pDecodingCorrection, 48);      // ((9 + 1 + 1) 8 + 5 + 2) / 2 = 47.5
    EXPECT_EQ(p.pMacroInitialOffsetA, 10);     // 7 + (48 + 50) 25 ns = 2.45 us
    EXPECT_EQ(p.pMicroInitialOffsetB, 22);     // 3 us - 2.45 us = 0.55 us
    EXPECT_EQ(p.pLatestTx, 60);
  }
}

TEST(Derive, AKeyThatNoOtherDeterminesIsMissing) {
  const auto missing = [](const std::vector<std::string>& names) {
    std::string keys;
    for (const Finding& one : findings_of(paper_without(names)))
      keys += one.key + " " + one.expected.substr(0, 10) + ";";
    return keys;
  };
  EXPECT_EQ(missing({"gdBit", "baudrate"}), "flexray.baudrate is missing;flexray.gdBit is missing;");
  EXPECT_EQ(missing({"gdTSSTransmitter"}), "flexray.gdTSSTransmitter is missing;");
  EXPECT_TRUE(
      missing({"gdCycle", "gMacroPerCycle", "gdNIT"}).starts_with("flexray.gMacroPerCycle is missing;sensors."));
}

TEST(Derive, AValueOutsideItsRangeIsAFinding) {
  const std::string text =
      support::replaced(paper_without({"gdNIT"}), "gNumberOfStaticSlots: 40", "gNumberOfStaticSlots: 10");
  const auto findings = findings_of(text);
  ASSERT_FALSE(findings.empty());
  EXPECT_EQ(findings[0].key, "flexray.gdNIT");
  EXPECT_EQ(findings[0].expected,
            "is absent, and would be 2906, the rest of the cycle (18): must be 2..805 macroticks");
}

TEST(Derive, ThePageHasEveryRule) {
  std::ifstream stream(TTF_SOURCE_DIR "/docs/schedules/cluster_files.md", std::ios::binary);
  std::ostringstream page;
  page << stream.rdbuf();
  const auto has = [&](std::string_view parameter, std::string_view derivation) {
    EXPECT_NE(page.str().find(fmt::format("| `{}` | {} |", parameter, derivation)), std::string::npos) << parameter;
  };
  for (const GlobalRule& rule : global_rules()) has(rule.parameter, rule.derivation);
  for (const NodeRule& rule : clock_rules()) has(rule.parameter, rule.derivation);
  for (const NodeRule& rule : node_rules()) has(rule.parameter, rule.derivation);
}

}  // namespace
}  // namespace ttf::schedules::file
