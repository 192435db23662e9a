// The table of FlexRay's constraints: each has a cluster that fails because of it alone, and a row in the documents.
#include "schedules/check/constraints.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <functional>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "schedules/analysis/clock_bounds.h"
#include "tests/schedules/cluster_file.h"

namespace ttf::schedules::check {
namespace {

using model::Cluster;
using model::GlobalParameters;
using model::NodeParameters;

// The names of the constraints that do not hold, each once, in the order of the table.
std::vector<std::string> violated(const Cluster& cluster) {
  std::int64_t worst = 0;
  for (const model::Node& node : cluster.nodes)
    if (node.flexray) worst = std::max(worst, analysis::worst_drift_ppb(node));
  std::vector<std::string> names;
  for (const Constraint& one : constraints()) {
    const NodeParameters none;
    bool holds = one.on == Constraint::On::kController || one.holds({cluster, none});
    if (one.on == Constraint::On::kController)
      for (const model::Node& node : cluster.nodes)
        holds = holds && (!node.flexray || one.holds({cluster, *node.flexray, analysis::worst_drift_ppb(node), worst}));
    if (!holds) names.emplace_back(one.name);
  }
  return names;
}

// Changes of flexray_demo.yaml, by constraint. A change that moves other bounds moves those parameters along.
const std::map<std::string, std::function<void(GlobalParameters&, NodeParameters&)>>& breaks() {
  using G = GlobalParameters;
  using P = NodeParameters;
  static const std::map<std::string, std::function<void(G&, P&)>> kBreaks{
      {"cycle_sum", [](G& g, P&) { g.gdNIT = 428; }},
      {"cycle_length",
       [](G& g, P& p) {
         g.gdCycle_ps *= 2;
         p.pMicroPerCycle *= 2;
         p.pRateCorrectionOut = 481;
         p.pdListenTimeout = 2 * (p.pMicroPerCycle + p.pRateCorrectionOut);
       }},
      {"static_slot", [](G& g, P&) { g.gdStaticSlot = 49, g.gdNIT = 447; }},
      {"action_point", [](G& g, P&) { g.gdActionPointOffset = 2; }},
      {"symbol_window", [](G& g, P&) { g.gdSymbolWindow = 12, g.gdNIT = 428; }},
      {"offset_correction_start", [](G& g, P&) { g.gOffsetCorrectionStart = 1572; }},
      {"fatal_after_passive", [](G& g, P&) { g.gMaxWithoutClockCorrectionFatal = 1; }},
      {"cas_length", [](G& g, P&) { g.gdCASRxLowMax = 78; }},
      {"wakeup_low", [](G& g, P&) { g.gdWakeupSymbolTxLow = 59; }},
      {"wakeup_idle", [](G& g, P&) { g.gdWakeupSymbolTxIdle = 179; }},
      {"wakeup_heard_low", [](G& g, P&) { g.gdWakeupSymbolRxLow = 60; }},
      {"wakeup_heard_idle", [](G& g, P&) { g.gdWakeupSymbolRxIdle = 60; }},
      {"wakeup_window", [](G& g, P&) { g.gdWakeupSymbolRxWindow = 300; }},
      {"minislot_action_point", [](G& g, P&) { g.gdMinislotActionPointOffset = 2, g.gdNIT = 426; }},
      {"minislot", [](G& g, P&) { g.gdMinislot = 6, g.gdNIT = 507; }},
      {"idle_phase", [](G& g, P&) { g.gdDynamicSlotIdlePhase = 0; }},
      {"microticks_per_cycle", [](G&, P& p) { p.pMicroPerCycle = 79'999, p.pdListenTimeout = 160'480; }},
      {"longest_microtick", [](G& g, P& p) { g.gdMaxMicrotick_ps = 12'500, p.pClusterDriftDamping = 0; }},
      {"rate_correction", [](G&, P& p) { p.pRateCorrectionOut = 240, p.pdListenTimeout = 160'480; }},
      {"offset_correction", [](G&, P& p) { p.pOffsetCorrectionOut = 101; }},
      {"drift_damping", [](G&, P& p) { p.pClusterDriftDamping = 2; }},
      {"listen_timeout", [](G&, P& p) { p.pdListenTimeout = 1284; }},
      {"accepted_startup_range", [](G&, P& p) { p.pdAcceptedStartupRange = 102; }},
      {"delay_compensation_a", [](G&, P& p) { p.pDelayCompensationA = 25; }},
      {"delay_compensation_b", [](G&, P& p) { p.pDelayCompensationB = 25; }},
  };
  return kBreaks;
}

TEST(Constraints, EachHasAClusterThatFailsBecauseOfItAlone) {
  const Cluster shipped = load_checked_cluster(shipped_path("flexray_demo"));
  EXPECT_EQ(breaks().size(), constraints().size());
  for (const Constraint& one : constraints()) {
    SCOPED_TRACE(one.name);
    ASSERT_TRUE(breaks().contains(one.name));
    Cluster cluster = shipped;
    for (model::Node& node : cluster.nodes) {
      GlobalParameters g = shipped.flexray;
      breaks().at(one.name)(g, *node.flexray);
      cluster.flexray = g;
    }
    EXPECT_EQ(violated(cluster), std::vector<std::string>{one.name});
    const std::vector<Finding> findings = check(cluster);
    const bool reported = std::ranges::any_of(findings, [&](const Finding& finding) {
      return finding.key.ends_with(std::string(".") + one.parameter) && finding.expected.starts_with("must ");
    });
    EXPECT_TRUE(reported) << sentences(findings);
  }
}

// A coldstart node with a short listen timeout disturbs a running cluster. One with a narrow range, or with a
// compensation that no cable needs, never starts.
TEST(Constraints, SayWhatTheyWant) {
  const std::string demo = shipped_text("flexray_demo");
  const auto said = [&](const std::string& from, const std::string& to) {
    std::string text = demo;
    text.replace(text.find(from), from.size(), to);
    return sentences(findings_of(text));
  };
  EXPECT_NE(said("pdListenTimeout: 160482", "pdListenTimeout: 1284").find("must be 160482 microticks"),
            std::string::npos);
  EXPECT_NE(said("pdAcceptedStartupRange: 200", "pdAcceptedStartupRange: 0").find("must be at least 103 microticks"),
            std::string::npos);
  EXPECT_NE(said("pDelayCompensationA: 12", "pDelayCompensationA: 200").find("must be 0..24 microticks"),
            std::string::npos);
}

// docs/schedules/flexray_constraints.md has a row for each, with its derivation.
TEST(Constraints, AreDocumented) {
  std::ifstream stream(TTF_SOURCE_DIR "/docs/schedules/flexray_constraints.md");
  std::ostringstream page;
  page << stream.rdbuf();
  const std::string table = page.str().substr(0, page.str().find("\n## Not checked"));
  std::size_t rows = 0;
  for (std::size_t at = table.find("\n| `"); at != std::string::npos; at = table.find("\n| `", at + 1)) ++rows;
  EXPECT_EQ(rows, constraints().size());
  for (const Constraint& one : constraints()) {
    const std::string row = std::string("\n| `") + one.name + "` | `" + one.derivation + "` |";
    EXPECT_NE(table.find(row), std::string::npos) << row;
  }
}

}  // namespace
}  // namespace ttf::schedules::check
