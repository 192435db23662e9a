// Reports of mistakes in a cluster file; each rule is in one of mutation_*_test.cc.
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/schedules/cluster_file.h"
#include "tests/support/patterns.h"

namespace ttf::schedules::check {
namespace {

TEST(Mutations, AMistakeInTheSharedParametersIsReportedOnce) {
  const std::string text =
      support::replaced(shipped_text("paper_unsynchronised"), "pWakeupPattern: 2", "pWakeupPattern: 99");
  EXPECT_EQ(findings_of(text).size(), 1u) << sentences(findings_of(text));
}

TEST(Mutations, ASlotWithManyOwnersIsSaidOncePerFrameTooMany) {
  const std::string text = support::replaced(shipped_text("paper_unsynchronised"), "(slot: )[2-5],", "$011,");
  const auto findings = findings_of(text);
  EXPECT_EQ(std::count_if(findings.begin(), findings.end(),
                          [](const Finding& f) { return f.expected.find("owned twice") != std::string::npos; }),
            4)
      << sentences(findings);
}

TEST(Mutations, AllMistakesAreReportedAtOnce) {
  std::string text = shipped_text("paper_unsynchronised");
  for (const char* key : {"gListenNoise", "gColdStartAttempts", "gdCASRxLowMax"})
    text = support::replaced(text, std::string(key) + ": [0-9]+", std::string(key) + ": 1000");
  EXPECT_EQ(findings_of(text).size(), 3u) << sentences(findings_of(text));
}

TEST(Mutations, LinesAreThoseOfTheParameter) {
  std::string text = shipped_text("paper_unsynchronised");
  const auto at = text.find("gdStaticSlot: 84");
  ASSERT_NE(at, std::string::npos);
  const auto line = 1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n');
  text.replace(at, 16, "gdStaticSlot: 83");
  const auto findings = findings_of(text);
  const auto found =
      std::find_if(findings.begin(), findings.end(), [](const Finding& f) { return f.key == "flexray.gdStaticSlot"; });
  ASSERT_NE(found, findings.end());
  EXPECT_EQ(found->line, line);
}

// A missing section leaves many keys unread. Each finding about them points to the section's proper place.
TEST(Mutations, EveryFindingAboutAMissingSectionHasALine) {
  for (const char* section :
       {"name", "synchronisation", "flexray", "node_parameters", "pdus", "sensors", "nodes", "frames", "can"}) {
    const std::string text = support::replaced("\n" + shipped_text("paper_unsynchronised"),
                                               "\n" + std::string(section) + ":", "\nno_" + std::string(section) + ":");
    const auto findings = findings_of(text);
    ASSERT_GE(findings.size(), 2u) << section;
    for (const Finding& finding : findings) EXPECT_GT(finding.line, 0) << finding.sentence();
  }
}

// Numbers of CANs are signed bytes in records, those of nodes bytes.
TEST(Mutations, MoreNamesThanRecordsCanNumber) {
  const auto with_more = [](const std::string& section, const std::string& entry, int more) {
    std::string text = shipped_text("paper_unsynchronised"), added;
    for (int i = 0; i < more; ++i) added += "  more_" + std::to_string(i) + ": " + entry + "\n";
    text.insert(text.find("\n" + section + ":\n") + section.size() + 3, added);
    return findings_of(text);
  };
  const auto about = [](const std::vector<Finding>& findings, const std::string& key) {
    return std::find_if(findings.begin(), findings.end(), [&](const Finding& f) { return f.key == key; });
  };
  const std::string can = "{flexible_data_rate: false, nominal_bit_rate: 1000000, other_load: 0, messages: []}";
  EXPECT_TRUE(with_more("can", can, 124).empty()) << sentences(with_more("can", can, 124));  // 127
  const auto cans = with_more("can", can, 125);
  ASSERT_NE(about(cans, "can"), cans.end());
  EXPECT_EQ(about(cans, "can")->expected, "must have at most 127 entries; it has 128");
  const std::string node = "{microtick: 25, max_drift_ppm: 100, tasks: {}}";
  EXPECT_TRUE(with_more("nodes", node, 193).empty()) << sentences(with_more("nodes", node, 193));  // 200
  const auto nodes = with_more("nodes", node, 194);
  ASSERT_NE(about(nodes, "nodes"), nodes.end());
  EXPECT_EQ(about(nodes, "nodes")->expected, "must have at most 200 entries; it has 201");
}

TEST(Mutations, ATruncatedFileIsNeverAccepted) {
  const std::string text = shipped_text("paper_unsynchronised");
  // A cut may leave valid YAML, but never a whole cluster, except behind the last line.
  for (std::size_t length = 0; length + 40 < text.size(); length += 97)
    EXPECT_FALSE(findings_of(text.substr(0, length)).empty()) << "cut after " << length << " bytes";
}

TEST(Mutations, AnUnreadableFileIsOneFinding) {
  try {
    file::load_cluster(shipped_path("no_such_cluster"));
    FAIL() << "loaded what does not exist";
  } catch (const InputError& error) {
    ASSERT_EQ(error.findings().size(), 1u);
    EXPECT_NE(error.findings()[0].sentence().find("no_such_cluster"), std::string::npos);
  }
}

}  // namespace
}  // namespace ttf::schedules::check
