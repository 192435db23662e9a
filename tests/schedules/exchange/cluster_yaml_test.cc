// Every shipped cluster, written and read again, is the same cluster.
#include "schedules/exchange/cluster_yaml.h"

#include <gtest/gtest.h>

#include "schedules/analysis/ages.h"
#include "schedules/exchange/text.h"
#include "tests/schedules/cluster_file.h"

namespace ttf::schedules::exchange {
namespace {

class Written : public testing::TestWithParam<std::string> {};

TEST_P(Written, IsReadAsTheSameCluster) {
  const model::Cluster original = file::load_cluster(shipped_path(GetParam()));
  const std::string text = cluster_yaml(original, "A comment");
  const model::Cluster again = file::parse_cluster(text, "again.yaml");
  EXPECT_EQ(cluster_yaml(again, "A comment"), text);
  model::Cluster whole = original;
  whole.derived.clear();  // the written text leaves nothing out
  EXPECT_EQ(show_text(again), show_text(whole));
  EXPECT_EQ(analysis::ages_text(again), analysis::ages_text(original));
  ASSERT_EQ(again.frames.size(), original.frames.size());
  for (std::size_t f = 0; f < again.frames.size(); ++f) {
    EXPECT_EQ(again.frames[f].fragment, original.frames[f].fragment);
    EXPECT_EQ(again.frames[f].slot, original.frames[f].slot);
    EXPECT_EQ(again.frames[f].message_id, original.frames[f].message_id);
    EXPECT_EQ(again.frames[f].network_management, original.frames[f].network_management);
  }
  for (std::size_t p = 0; p < again.pdus.size(); ++p)
    for (std::size_t s = 0; s < again.pdus[p].element.size(); ++s) {
      EXPECT_EQ(again.pdus[p].element[s].low, original.pdus[p].element[s].low);
      EXPECT_EQ(again.pdus[p].element[s].high, original.pdus[p].element[s].high);
      EXPECT_EQ(again.pdus[p].element[s].resolution, original.pdus[p].element[s].resolution);
    }
  const auto findings = check::check(again);
  EXPECT_TRUE(findings.empty()) << sentences(findings);
}

INSTANTIATE_TEST_SUITE_P(Clusters, Written, testing::ValuesIn(shipped_clusters()),
                         [](const auto& parameter) { return parameter.param; });

}  // namespace
}  // namespace ttf::schedules::exchange
