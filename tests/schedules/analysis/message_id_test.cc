// Message ids of dynamic frames, and external correction terms: the rules for cluster files.
#include <gtest/gtest.h>

#include <algorithm>

#include "schedules/analysis/minislots.h"
#include "tests/schedules/cluster_file.h"
#include "tests/support/patterns.h"

namespace ttf::schedules::analysis {
namespace {

std::string changed(const std::string& pattern, const std::string& replacement,
                    const std::string& file = "flexray_demo") {
  const std::string original = shipped_text(file);
  const std::string text = support::replaced_first(original, pattern, replacement);
  EXPECT_NE(text, original) << pattern;
  return text;
}
bool found(const std::vector<Finding>& findings, const std::string& key, const std::string& value,
           const std::string& words) {
  return std::any_of(findings.begin(), findings.end(), [&](const Finding& finding) {
    return finding.key == key && finding.value == value && finding.expected.find(words) != std::string::npos;
  });
}

TEST(MessageIds, AreTwoBytesOfADynamicFrame) {
  const model::Cluster plain = file::parse_cluster(shipped_text("flexray_demo"), "cluster.yaml");
  const model::Cluster named =
      file::parse_cluster(changed("(pdu: camera_objects, fragments: 2)", "$1, message_id: 4660"), "cluster.yaml");
  ASSERT_EQ(plain.frames.size(), named.frames.size());
  int frames = 0;
  for (std::size_t i = 0; i < plain.frames.size(); ++i) {
    EXPECT_FALSE(plain.frames[i].message_id.has_value());
    if (!named.frames[i].message_id) continue;
    ++frames;
    EXPECT_EQ(named.frames[i].message_id, 0x1234);
    EXPECT_EQ(dynamic_words(named, named.frames[i]), dynamic_words(plain, plain.frames[i]) + 1);
  }
  EXPECT_EQ(frames, 2);  // every fragment of the list
  EXPECT_EQ(check::check(named).size(), check::check(plain).size());
}

TEST(MessageIds, AreRefusedWhereTheyCannotBe) {
  EXPECT_TRUE(found(findings_of(changed("(pdu: image, fragments: 4)", "$1, message_id: 7")), "frames[6] (slot 7)",
                    "message_id: 7", "needs a dynamic slot, above 20 (gNumberOfStaticSlots)"));
  EXPECT_TRUE(found(findings_of(changed("(pdu: camera_objects, fragments: 2)", "$1, message_id: 65536")),
                    "frames[8].message_id", "65536", "0..65535"));
  model::Cluster cluster =
      file::parse_cluster(changed("(pdu: camera_objects, fragments: 2)", "$1, message_id: 65535"), "cluster.yaml");
  const auto pdu = index_of(*cluster.find_pdu("camera_objects"));
  for (const int bytes : {252, 253}) {
    cluster.pdus[pdu].fragment_bytes = bytes;
    EXPECT_EQ(found(check::check(cluster), "frames[8] (slot 23)", "camera_objects (253 bytes)", "at most 252 bytes"),
              bytes == 253);
  }
}

TEST(ExternalCorrection, IsNoneUnlessAllowed) {
  const model::Cluster plain = file::parse_cluster(shipped_text("paper_unsynchronised"), "cluster.yaml");
  const model::Cluster allowed = file::parse_cluster(
      changed("\\bpWakeupPattern: 2", "pWakeupPattern: 2\n  pExternOffsetCorrection: 7\n  pExternRateCorrection: 1",
              "paper_unsynchronised"),
      "cluster.yaml");
  for (std::size_t n = 0; n < plain.nodes.size(); ++n) {
    if (!plain.nodes[n].flexray) continue;
    EXPECT_EQ(plain.nodes[n].flexray->pExternOffsetCorrection, 0);
    EXPECT_EQ(plain.nodes[n].flexray->pExternRateCorrection, 0);
    EXPECT_EQ(allowed.nodes[n].flexray->pExternOffsetCorrection, 7);
    EXPECT_EQ(allowed.nodes[n].flexray->pExternRateCorrection, 1);
  }
  EXPECT_TRUE(check::check(allowed).empty());
}

TEST(ExternalCorrection, RangesAreThoseOfTheRegister) {
  for (const std::string name : {"pExternOffsetCorrection", "pExternRateCorrection"})
    for (const auto& [value, right] : {std::pair{"-1", false}, {"0", true}, {"7", true}, {"8", false}})
      EXPECT_EQ(found(findings_of(changed("\\bpWakeupPattern: 2", "pWakeupPattern: 2\n  " + name + ": " + value,
                                          "paper_unsynchronised")),
                      "node_parameters." + name, value, "0..7 microticks"),
                !right)
          << name << ' ' << value;
}

// 386 macroticks of 40 microticks less 601 in 5000 are 15393.. of which one each stays. 3887 fit without an
// external term.
TEST(ExternalCorrection, TakesOfTheRoomForOffsetCorrection) {
  const auto limit = [](int offset, const std::string& external) {
    return findings_of(changed("(pOffsetCorrectionOut: )[0-9]+([^~]*\\bpWakeupPattern: 2)",
                               "$01" + std::to_string(offset) + "$02" + external, "paper_unsynchronised"));
  };
  const std::string key = "nodes.laser_pre.flexray.pOffsetCorrectionOut";
  EXPECT_TRUE(limit(3887, "").empty());
  EXPECT_TRUE(limit(3880, "\n  pExternOffsetCorrection: 7").empty());
  EXPECT_TRUE(found(limit(3881, "\n  pExternOffsetCorrection: 7"), key, "3881", "274..3880 microticks"));
}

}  // namespace
}  // namespace ttf::schedules::analysis
