// Clusters without instants, slots and deadlines.
#include "schedules/file/fill_in.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/random.h"
#include "schedules/analysis/ages.h"
#include "schedules/file/vary.h"
#include "tests/schedules/left_out/left_out_text.h"
#include "tests/support/patterns.h"

namespace ttf::schedules::file {
namespace {

using left_out::without_derived;

// Their instants follow from the measurements.
const std::vector<std::string> kScheduled{
    "paper_synchronised",       "paper_planned",       "two_lasers_synchronised",      "surround_synchronised",
    "closed_loop_synchronised", "closed_loop_planned", "driven_surround_synchronised", "laser_and_radar_synchronised",
    "four_kinds_synchronised"};

class LeftOut : public testing::TestWithParam<std::string> {};

TEST_P(LeftOut, InstantsFollowAndPassTheCheck) {
  const model::Cluster cluster = parse_cluster(without_derived(GetParam()), "cluster.yaml");
  EXPECT_EQ(sentences(check::check(cluster)), "");
  EXPECT_GE(cluster.derived.size(), 40U);
}

// Every value that follows is written in the whole file, which says the same.
TEST_P(LeftOut, TheWholeFileIsTheSameCluster) {
  const model::Cluster cluster = parse_cluster(without_derived(GetParam()), "cluster.yaml");
  const std::string whole = exchange::cluster_yaml(cluster, "");
  const model::Cluster again = parse_cluster(whole, "whole.yaml");
  EXPECT_TRUE(again.derived.empty());
  EXPECT_EQ(exchange::cluster_yaml(again, ""), whole);
}

// Any of these values may be written or left out: it is the same cluster.
TEST_P(LeftOut, AnyPartOfItMayBeWritten) {
  const std::string whole = exchange::cluster_yaml(parse_cluster(without_derived(GetParam()), "cluster.yaml"), "");
  RandomStream draws({11});
  for (int draw = 0; draw < 20; ++draw) {
    const double share = draws.uniform();
    const std::string text = without_derived(whole, [&] { return draws.uniform() < share; });
    EXPECT_EQ(exchange::cluster_yaml(parse_cluster(text, "part.yaml"), ""), whole) << text;
  }
}

Duration sum_of_ages(const model::Cluster& cluster) {
  Duration sum{};
  for (const analysis::AgePath& path : analysis::measurement_ages(cluster)) sum += path.use_worst;
  return sum;
}

// A macrotick earlier, and the data of this round is not there, or the processor is taken.
TEST_P(LeftOut, NoTaskOnTheWayToTheUseCanBeginEarlier) {
  const model::Cluster cluster = parse_cluster(without_derived(GetParam()), "cluster.yaml");
  const Duration before = sum_of_ages(cluster);
  int tried = 0;
  for (std::size_t n = 0; n < cluster.nodes.size(); ++n)
    for (std::size_t t = 0; t < cluster.nodes[n].tasks.size(); ++t) {
      const std::string step = cluster.nodes[n].tasks[t].step;
      const model::CycleInstant& at = cluster.nodes[n].tasks[t].activation.at;
      if (cluster.nodes[n].tasks[t].activation.kind != model::ActivationKind::kTime || at.offset.value == 0) continue;
      if (step != "fusion" && step != "image_output" && step != "feature_service" && !step.ends_with("_preprocessing"))
        continue;
      model::Cluster earlier = cluster;
      earlier.nodes[n].tasks[t].activation.at.offset = Macroticks{at.offset.value - 1};
      EXPECT_TRUE(!check::check(earlier).empty() || sum_of_ages(earlier) > before) << step;
      ++tried;
    }
  EXPECT_GE(tried, 2);
}

INSTANTIATE_TEST_SUITE_P(Clusters, LeftOut, testing::ValuesIn(kScheduled),
                         [](const auto& parameter) { return parameter.param; });

// The first finding about a change to the text without instants.
std::string first_finding(const std::string& words, const std::string& by) {
  std::string text = without_derived("paper_planned");
  const std::string before = text;
  text = support::replaced_first(text, words, by);
  EXPECT_NE(text, before) << words;
  const auto findings = findings_of(text);
  return findings.empty() ? "" : findings.front().key + ": " + findings.front().expected;
}

TEST(FillIn, BothPartsOfAnInstantAreWrittenOrNone) {
  EXPECT_EQ(first_finding("kind: time", "kind: time, offset: 5"),
            "nodes.laser_pre.tasks.preprocess.activation.base_cycle: is missing: base_cycle and offset are both "
            "written, or both left out");
  EXPECT_EQ(first_finding("kind: time", "kind: time, base_cycle: 0"),
            "nodes.laser_pre.tasks.preprocess.activation.offset: is missing: base_cycle and offset are both written, "
            "or both left out");
  EXPECT_EQ(first_finding("pdu: image", "slot: 20, pdu: image"),
            "frames[5].base_cycle: is missing: base_cycle and slot are both written, or both left out");
}

TEST(FillIn, ABaseCycleIsBelowTheRepetitionThatFollows) {
  EXPECT_EQ(first_finding("kind: time", "kind: time, base_cycle: 4, offset: 5"),
            "nodes.laser_pre.tasks.preprocess.activation.base_cycle: must be below repetition, which follows: 0..3");
  EXPECT_EQ(first_finding("pdu: image", "slot: 70, base_cycle: 5, pdu: image"),
            "frames[5].base_cycle: must be below repetition, which follows: 0..3");
}

TEST(FillIn, SlotsFollowForWholeListsAlone) {
  for (const std::string key : {"first_fragment: 0", "fragment_step: 2", "network_management: true"})
    EXPECT_EQ(first_finding("pdu: image", "pdu: image, " + key),
              "frames[5]." + key.substr(0, key.find(':')) +
                  ": needs a slot, base_cycle and repetition: they follow for whole lists alone");
  EXPECT_EQ(first_finding("pdu: image", "pdu: image, fragments: 12"),
            "frames[5].fragments: must be 13, all of the list, where slot, base_cycle or repetition follow");
}

TEST(FillIn, ADynamicSlotHasItsCycles) {
  EXPECT_EQ(first_finding("pdu: image", "slot: 200, pdu: image").substr(0, 32), "frames[5].base_cycle: is missing");
}

// The cause is named: a frame that is too long, a load, a list without frames.
TEST(FillIn, ACanWithoutBoundsIsNamed) {
  EXPECT_EQ(first_finding("fragment_bytes: 8\n", "fragment_bytes: 16\n"),
            "can.camera_can.messages (camera_frame): must fit a frame of this CAN, at most 8 bytes");
  EXPECT_EQ(first_finding("nominal_bit_rate: 1000000\n    data", "nominal_bit_rate: 100000\n    data").substr(0, 121),
            "nodes.laser_pre.tasks.preprocess.activation.offset: must be in the file: laser_scan, which it reads, "
            "comes at no "
            "certain ");
  EXPECT_EQ(
      first_finding("  - \\{sender: laser_pre, pdu: laser_objects\\}\n", ""),
      "nodes.fusion.tasks.fuse_laser.activation.offset: must be in the file: laser_objects, which it reads, has no "
      "static slots");
}

// The status frames have the lowest slots that no one else has.
TEST(FillIn, StatusFramesHaveTheKeySlotOrTheLowestOne) {
  std::string text = without_derived("paper_planned");
  const model::Cluster keyed = parse_cluster(text, "keyed.yaml");
  text = support::replaced(text, "pKeySlotId: \\d", "");
  text = support::replaced(text, "sender: gateway", "slot: 2, sender: gateway");
  const model::Cluster lowest = parse_cluster(text, "lowest.yaml");
  for (const auto& [name, before, after] :
       {std::tuple{"laser_pre", 1, 1}, {"camera_pre", 2, 3}, {"gateway", 3, 2}, {"fusion", 4, 4}}) {
    EXPECT_EQ(keyed.node(*keyed.find_node(name)).flexray->pKeySlotId, before) << name;
    EXPECT_EQ(lowest.node(*lowest.find_node(name)).flexray->pKeySlotId, after) << name;
  }
}

TEST(PduLikeAnother, HasWhatItLacks) {
  std::string text = shipped_text("paper_planned");
  const model::Cluster whole = parse_cluster(text, "whole.yaml");
  text = support::replaced(text, "\n  camera_objects:\n( {4,}.*\n)*",
                           "\n  camera_objects: {like: laser_objects, sensor: camera, max_elements: 7}\n");
  const model::Cluster alike = parse_cluster(text, "like.yaml");
  const model::PduLayout& one = alike.pdu(*alike.find_pdu("camera_objects"));
  const model::PduLayout& other = whole.pdu(*whole.find_pdu("laser_objects"));
  EXPECT_EQ(one.sensor, whole.pdu(*whole.find_pdu("camera_objects")).sensor);
  EXPECT_EQ(one.max_elements, 7);
  EXPECT_EQ(one.fragment_bytes, other.fragment_bytes);
  EXPECT_EQ(one.element.size(), other.element.size());
  EXPECT_EQ(one.element_bits, other.element_bits);
  for (const std::string wrong : {"camera_objects", "nothing"}) {
    const std::string refused = support::replaced(text, "like: laser_objects", "like: " + wrong);
    const auto findings = findings_of(refused);
    ASSERT_FALSE(findings.empty());
    EXPECT_EQ(findings[0].key, "pdus.camera_objects.like");
  }
}

TEST(FillIn, AStatusFrameKeepsOffTheSlotsOfLists) {
  std::string text = support::replaced(without_derived("paper_planned"), "pKeySlotId: \\d", "");
  text = support::replaced(text, "pdu: image", "slot: 1, base_cycle: 0, pdu: image");
  const model::Cluster cluster = parse_cluster(text, "cluster.yaml");
  EXPECT_EQ(cluster.node(*cluster.find_node("laser_pre")).flexray->pKeySlotId, 14);
}

TEST(FillIn, AnExperimentVariesWhatFollows) {
  const ClusterText text{without_derived("paper_planned"), "cluster.yaml", {}};
  EXPECT_TRUE(leaves_out(text, "nodes.fusion.tasks.publish.activation.repetition"));
  EXPECT_TRUE(leaves_out(text, "nodes.fusion.tasks.publish.deadline"));
  EXPECT_TRUE(leaves_out(text, "frames[7].repetition"));
  EXPECT_TRUE(leaves_out(text, "can.laser_can.messages[0].shortest_period"));
  EXPECT_FALSE(leaves_out(text, "nodes.fusion.tasks.publish.worst_case"));
  const model::Cluster later = parse_cluster(with_key(text, "nodes.fusion.tasks.publish.deadline", "700 us"));
  EXPECT_EQ(later.node(*later.find_node("fusion")).tasks.back().deadline, Duration::microseconds(700));
}

}  // namespace
}  // namespace ttf::schedules::file
