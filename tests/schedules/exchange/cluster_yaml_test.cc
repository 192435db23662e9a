// Every shipped cluster, written and read again, is the same cluster.
#include "schedules/exchange/cluster_yaml.h"

#include <gtest/gtest.h>

#include "schedules/analysis/ages.h"
#include "schedules/exchange/cluster_text.h"
#include "tests/schedules/cluster_dump.h"
#include "tests/schedules/cluster_file.h"
#include "tests/support/patterns.h"

namespace ttf::schedules::exchange {
namespace {

class Written : public testing::TestWithParam<std::string> {};

TEST_P(Written, IsReadAsTheSameCluster) {
  const model::Cluster original = file::load_cluster(shipped_path(GetParam()));
  const std::string text = cluster_yaml(original, "A comment");
  const model::Cluster again = file::parse_cluster(text, "again.yaml");
  EXPECT_EQ(again.name, original.name);
  EXPECT_EQ(dump(again), dump(original));
  EXPECT_TRUE(again.derived.empty());  // it leaves nothing out
  EXPECT_EQ(cluster_yaml(again, "A comment"), text);
  model::Cluster said = original;
  said.derived.clear();
  EXPECT_EQ(show_text(again), show_text(said));
  EXPECT_EQ(analysis::ages_text(again), analysis::ages_text(original));
  const auto findings = check::check(again);
  EXPECT_TRUE(findings.empty()) << sentences(findings);
}

// Names with signs of YAML, parameters that two controllers derive otherwise though they share one mapping.
TEST(WrittenCluster, StaysTheSameWithOddNamesAndASharedMapping) {
  std::string text = shipped_text("paper_synchronised");
  const auto replace = [&](const std::string& words, const std::string& by) {
    const std::string before = text;
    text = support::replaced(text, words, by);
    EXPECT_NE(text, before) << words;
  };
  replace("laser_objects", "'laser: objects, #1'");
  replace("'laser: objects, #1' on ([a-z_]+)", "'laser: objects, #1 on $1'");
  replace("flexray: \\{pKeySlotId: 1\\}", "flexray: &own {}");
  replace("flexray: \\{pKeySlotId: [0-9]\\}", "flexray: *own");
  const model::Cluster original = file::parse_cluster(text, "odd.yaml");
  EXPECT_FALSE(original.derived.empty());
  const model::Cluster again = file::parse_cluster(cluster_yaml(original, ""), "again.yaml");
  EXPECT_EQ(dump(again), dump(original));
  EXPECT_TRUE(again.derived.empty());
}

INSTANTIATE_TEST_SUITE_P(Clusters, Written, testing::ValuesIn(shipped_clusters()),
                         [](const auto& parameter) { return parameter.param; });

}  // namespace
}  // namespace ttf::schedules::exchange
