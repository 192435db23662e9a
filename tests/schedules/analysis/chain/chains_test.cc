// Chains to an actuator in the small cluster of tests/schedules/small_cluster.h, worked out by hand.
#include "schedules/analysis/chain/chains.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "tests/schedules/cluster_file.h"
#include "tests/schedules/small_cluster.h"

namespace ttf::schedules::analysis::chain {
namespace {

//   user:      serve at 1 ms of even cycles -> command in slot 5 of odd cycles (336..420 us)
//   actuator:  act at 0.5 ms of odd cycles
model::Cluster driving(bool scheduled) {
  model::Cluster cluster = small(scheduled);
  cluster.pdus.push_back(cluster.pdus[1]);
  model::Task serve = timed("serve", {0, 2, Macroticks{1000}}, Duration::microseconds(100));
  serve.reads = cluster.nodes[2].tasks[0].reads;
  serve.writes = {{"command", PduId{2}, model::kFlexRay, 0}};
  cluster.nodes[2].tasks.push_back(serve);
  model::Node actuator = cluster.nodes[2];
  model::Task act = timed("act", {1, 2, Macroticks{500}}, Duration::microseconds(100));
  act.reads = {{"command", PduId{2}, model::kFlexRay, 0}};
  actuator.tasks = {act};
  cluster.nodes.push_back(actuator);
  cluster.frames.push_back({5, model::Channels::kAB, 1, 2, NodeId{2}, PduId{2}, 0, 0});
  return cluster;
}

// Measured at 0, fused at 6 ms, published at 10 ms, served at 11 ms. The actuator reads at 15.5 ms. The next
// measurement sees what this one missed.
TEST(Chains, OfAScheduledSensorAreExact) {
  const auto found = chains(driving(true));
  ASSERT_EQ(found.size(), 1u);
  const Chain& chain = found[0];
  EXPECT_TRUE(chain.exact);
  EXPECT_TRUE(chain.fused);
  EXPECT_EQ(chain.command, PduId{2});
  EXPECT_EQ(chain.reduced_reaction_best().ns, 15'500'000 - kClocks);
  EXPECT_EQ(chain.reduced_reaction_worst().ns, 15'500'000 + kClocks);
  EXPECT_EQ(chain.reaction_worst().ns, 25'500'000 + kClocks + kApart);
  EXPECT_EQ(chain.age_worst(), chain.reaction_worst());
  // Each reading has a newer measurement.
  EXPECT_EQ(chain.reduced_age_worst().ns, 15'500'000 + kClocks + kApart);
  Duration best{}, worst{};
  for (const Contribution& part : chain.path.to_use) best += part.best, worst += part.worst;
  EXPECT_EQ(best, chain.reduced_reaction_best());
  EXPECT_EQ(worst, chain.reduced_reaction_worst());
}

// Phases are those of Ages.OfAFreeSensorAreTheAdversePhases. The actuator reads 5 ms behind the image's use.
TEST(Chains, OfAFreeSensorAreBounds) {
  const auto found = chains(driving(false));
  ASSERT_EQ(found.size(), 1u);
  EXPECT_FALSE(found[0].exact);
  EXPECT_EQ(found[0].reduced_reaction_worst().ns, 1'000'000 + kRounding + 20'332'000 - 1 + kClocks);
  EXPECT_EQ(found[0].reduced_reaction_best().ns, 1'000'000 - kRounding + 10'500'000 - 175'000 - kClocks);
  EXPECT_NEAR(in_us(found[0].reaction_worst() - found[0].reduced_reaction_worst()), 10'000.0, 0.01);
  EXPECT_GT(found[0].reduced_reaction_worst(true), found[0].reduced_reaction_worst());
}

// The image's instant may come while the fusion still runs. Its task then follows directly.
TEST(Chains, AnImageFollowsTheFusionThatItsInstantInterrupts) {
  model::Cluster cluster = driving(true);
  cluster.nodes[1].tasks[0].worst_case = Duration::milliseconds(4);  // from 6 to 10 ms, and rounding
  const auto found = chains(cluster);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_TRUE(found[0].exact);
  EXPECT_EQ(found[0].reduced_reaction_worst().ns, 15'500'000 + kClocks);
}

TEST(Chains, AreNoneWithoutAServiceThatCommands) {
  EXPECT_TRUE(chains(small(true)).empty());
  EXPECT_EQ(chains_text(small(true)), "");
  model::Cluster cluster = driving(true);
  cluster.nodes[2].tasks[1].reads.clear();  // commands that rest on no image
  EXPECT_TRUE(chains(cluster).empty());
}

// Some pictures are not looked at: there is no bound from an event on.
TEST(Chains, ThroughADetectorBeginWithAPictureThatItLooksAt) {
  model::Cluster cluster = driving(true);
  EXPECT_TRUE(chains(cluster)[0].looks_at_all());
  cluster.nodes[0].tasks[0].holds = Duration::milliseconds(20);
  const auto found = chains(cluster);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_FALSE(found[0].looks_at_all());
  EXPECT_GE(found[0].reduced_reaction_worst(), Duration::microseconds(35'500));
  const std::string text = chains_text(cluster), all = chains_text(driving(true));
  EXPECT_NE(text.find("picture looked at to first command"), std::string::npos);
  EXPECT_NE(text.find("first command, if held"), std::string::npos);
  for (const char* row : {"first picture to", "reaction time, ", "data age when", "data age until"}) {
    EXPECT_EQ(text.find(row), std::string::npos) << row;
    EXPECT_NE(all.find(row), std::string::npos) << row;
  }
}

// A region of interest returns to its camera. No chain goes round.
TEST(Chains, AFeedbackEndsTheSearch) {
  model::Cluster cluster = driving(true);
  cluster.pdus.push_back(cluster.pdus[2]);
  cluster.nodes[2].tasks[1].writes.push_back({"region", PduId{3}, model::kFlexRay, 0});
  cluster.nodes[1].tasks[1].reads.push_back({"region", PduId{3}, model::kFlexRay, 0});
  EXPECT_TRUE(chains(cluster).empty()) << "a publisher that reads commands is a service";
  cluster.nodes[1].tasks[1].reads.clear();
  cluster.nodes[0].tasks[0].reads.push_back({"region", PduId{3}, model::kFlexRay, 0});
  EXPECT_EQ(chains(cluster).size(), 1u);
}

TEST(Chains, OfTheShippedLoopsLeadThroughBothServices) {
  for (const char* name : {"closed_loop_synchronised", "closed_loop_unsynchronised"}) {
    const model::Cluster cluster = file::load_cluster(shipped_path(name));
    const auto found = chains(cluster);
    ASSERT_EQ(found.size(), 6u) << "three sensors, two services";
    for (const Chain& chain : found) {
      EXPECT_EQ(chain.exact, std::string(name) == "closed_loop_synchronised") << chain.name;
      EXPECT_EQ(chain.fused, cluster.sensor(chain.sensor).kind != model::SensorKind::kOdometry);
      EXPECT_LT(chain.reduced_reaction_best(), chain.reduced_reaction_worst());
      EXPECT_LE(chain.reduced_reaction_worst(), chain.reduced_age_worst());
      EXPECT_LE(chain.reduced_age_worst(), chain.age_worst());
    }
    const std::string text = chains_text(cluster, Duration::milliseconds(50));
    EXPECT_NE(text.find("camera -> camera_pre.preprocess -> gateway.forward_camera -> fusion.fuse -> feature.cruise -> "
                        "actuator.act"),
              std::string::npos);
    EXPECT_NE(text.find("dead time"), std::string::npos);
  }
  EXPECT_TRUE(chains(file::load_cluster(shipped_path("paper_synchronised"))).empty());
}

// Two services read the image, and lane keeping reads marks. Marks come with the boxes of the same picture.
TEST(Chains, OfMarksOfLanesPassTheFusionBy) {
  for (const char* name : {"driven_surround_synchronised", "driven_surround_unsynchronised"}) {
    std::vector<Chain> marks;
    const auto found = chains(file::load_cluster(shipped_path(name)));
    EXPECT_EQ(found.size(), 7u * 2u + 2u) << "marks and odometry reach a third service";
    for (const Chain& chain : found) {
      EXPECT_EQ(std::ranges::count(found, chain.name, &Chain::name), 1) << chain.name;
      EXPECT_LE(chain.reduced_reaction_best(), chain.reduced_reaction_worst()) << chain.name;
      if (chain.name == "mono_camera -> mono_pre.preprocess -> feature.keep_lane -> actuator.act")
        marks.push_back(chain);
    }
    ASSERT_EQ(marks.size(), 1u);
    EXPECT_FALSE(marks[0].fused);
    EXPECT_EQ(marks[0].exact, std::string(name) == "driven_surround_synchronised");
    EXPECT_LT(marks[0].reduced_reaction_worst(), Duration::milliseconds(60));
  }
}

}  // namespace
}  // namespace ttf::schedules::analysis::chain
