#include "schedules/file/vary.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/schedules/cluster_file.h"
#include "tests/support/patterns.h"

namespace ttf::schedules::file {
namespace {

ClusterText paper_lacking(const std::string& parameter) {
  const std::string text = shipped_text("paper_synchronised");
  return {support::replaced(text, "\n  " + parameter + ": [^\n]*", ""), "cluster.yaml", {}};
}

TEST(Vary, OnlyAKeyThatAnotherDeterminesMayBeAbsent) {
  EXPECT_TRUE(leaves_out(paper_lacking("gdNIT"), "flexray.gdNIT"));
  EXPECT_FALSE(leaves_out(paper_lacking("gdNIT"), "flexray.gdStaticSlot"));  // written
  EXPECT_FALSE(leaves_out(paper_lacking("gdNIT"), "flexray.gdTypo"));
  EXPECT_FALSE(leaves_out(paper_lacking("gdNIT"), "gdNIT"));
  EXPECT_TRUE(leaves_out(paper_lacking("pLatestTx"), "node_parameters.pLatestTx"));
  EXPECT_TRUE(leaves_out(paper_lacking("pLatestTx"), "nodes.gateway.flexray.pLatestTx"));
  EXPECT_FALSE(leaves_out({"nodes: [", "cluster.yaml", {}}, "flexray.gdNIT"));
}

TEST(Vary, TheKeyHasItsValueAndNothingElseIsChanged) {
  const ClusterText with = with_key(paper_lacking("gdNIT"), "flexray.gdNIT", "500");
  EXPECT_EQ(parse_cluster(with).flexray.gdNIT, 500);
  const model::Cluster own =
      parse_cluster(with_key(paper_lacking("pLatestTx"), "nodes.gateway.flexray.pLatestTx", "7"));
  EXPECT_EQ(own.node(*own.find_node("gateway")).flexray->pLatestTx, 7);
  EXPECT_EQ(own.node(*own.find_node("fusion")).flexray->pLatestTx, 250);
}

TEST(Vary, DerivedValuesFollowVariedOnes) {
  ClusterText text = paper_lacking("gdNIT");
  text.text = support::replaced(text.text, "gNumberOfStaticSlots: 40", "gNumberOfStaticSlots: 38");
  EXPECT_EQ(parse_cluster(text).flexray.gdNIT, 386 + 2 * 84);
}

// A line of its own moves the lines behind it, and these still have their files.
TEST(Vary, LinesKeepTheirOrigins) {
  ClusterText text = paper_lacking("gdNIT");
  text.origins = TextOrigins({"base.yaml"});
  int lines = 0;
  for (const char c : text.text)
    if (c == '\n') text.origins.add(0, ++lines);
  const auto line_with = [](const std::string& all, const std::string& words) {
    return 1 +
           static_cast<int>(std::count(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(all.find(words)), '\n'));
  };
  const ClusterText with = with_key(text, "flexray.gdNIT", "500");
  const int before = line_with(text.text, "pWakeupPattern"), after = line_with(with.text, "pWakeupPattern");
  EXPECT_EQ(after, before + 1);
  EXPECT_EQ(with.origins.place("cluster.yaml", after).line, before);
  EXPECT_EQ(with.origins.place("cluster.yaml", after).file, "base.yaml");
}

}  // namespace
}  // namespace ttf::schedules::file
