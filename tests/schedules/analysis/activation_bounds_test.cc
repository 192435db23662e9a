// How often lists may activate a task: drawn writers and slots against the bounds. Over FlexRay, a list is
// sent every cycle and written far less often.
#include "schedules/analysis/activation_bounds.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "core/random.h"
#include "schedules/analysis/responses.h"
#include "schedules/analysis/slot_groups.h"
#include "tests/schedules/check/mutation.h"

namespace ttf::schedules::analysis {
namespace {

constexpr WritersOfLists kKnown = WritersOfLists::kKnown, kUnknown = WritersOfLists::kUnknown;

// Lists in the dynamic segment, or in every cycle's static slots.
model::Cluster over_flexray(bool dynamic) {
  std::string text = shipped_text("paper_free_flexray");
  if (!dynamic) {
    text.replace(text.find("slot: 35"), 8, "slot: 6");
    text.replace(text.find("slot: 44"), 8, "slot: 15");
  }
  const model::Cluster cluster = file::parse_cluster(text, "cluster.yaml");
  EXPECT_EQ(sentences(check::check(cluster)), "");
  return cluster;
}

const model::Task& task_of(const model::Cluster& cluster, const std::string& node, const std::string& name) {
  const auto& tasks = cluster.node(*cluster.find_node(node)).tasks;
  return *std::find_if(tasks.begin(), tasks.end(), [&](const model::Task& task) { return task.name == name; });
}

std::int64_t drawn(RandomStream& draws, std::int64_t low, std::int64_t high) {
  const std::int64_t kind = draws.integer(0, 3);
  return kind == 0 ? low : kind == 1 ? high : draws.integer(low, high);
}

// Completion instants of lists written at least `apart`, all clocks equal. Each goes out in the first cycle
// whose slots begin after it, or while it waits for the first of them.
std::vector<std::int64_t> arrivals_drawn(const model::Cluster& cluster, PduId pdu, std::int64_t apart,
                                         RandomStream& draws) {
  const auto groups = slot_groups(cluster, pdu);
  EXPECT_EQ(groups.size(), 1u);
  const auto at = [&](std::int64_t cycle, Macroticks offset) { return time_of(cluster.flexray, cycle, offset).ns; };
  std::vector<std::int64_t> arrivals;
  std::int64_t written = draws.integer(0, 5'000'000), cycle = 0;
  for (int list = 0; list < 400; ++list) {
    std::int64_t taken = 0;
    for (;; ++cycle) {
      taken = drawn(draws, at(cycle, groups[0].taken_from), at(cycle, groups[0].taken_by));
      if (taken >= written) break;
    }
    arrivals.push_back(drawn(draws, taken, at(cycle, groups[0].complete_by)));
    ++cycle;
    // Often as soon as may be, and often just before slots begin, or behind.
    written += apart;
    if (draws.integer(0, 1) == 0) {
      const std::int64_t slots = at(written / 5'000'000 + 1, groups[0].taken_from) + draws.integer(-1, 1);
      written = std::max(written, slots);
    }
  }
  return arrivals;
}

TEST(ActivationBounds, NoDrawnListsComeMoreOftenThanTheirBounds) {
  RandomStream draws({3, 0, Purpose::kTest, 0, 0});
  for (const bool dynamic : {true, false}) {
    const model::Cluster cluster = over_flexray(dynamic);
    for (const std::string sensor : {"laser", "camera"}) {
      SCOPED_TRACE(sensor + (dynamic ? ", dynamic" : ", static"));
      const processor::ActivationBounds bounds =
          activation_bounds(cluster, task_of(cluster, "fusion", "fuse_" + sensor), kKnown);
      ASSERT_EQ(bounds.all.size(), 2u);
      const auto host = worst_responses(cluster, *cluster.find_node(sensor + "_pre"));
      const std::int64_t apart = (*host)[0].written->ns;
      std::int64_t closest = INT64_MAX;
      for (int run = 0; run < 50; ++run) {
        const auto arrivals = arrivals_drawn(cluster, *cluster.find_pdu(sensor + "_objects"), apart, draws);
        for (std::size_t i = 0; i < arrivals.size(); ++i)
          for (std::size_t j = i; j < std::min(arrivals.size(), i + 12); ++j)
            ASSERT_LE(static_cast<std::int64_t>(j - i + 1), bounds.most(arrivals[j] - arrivals[i]));
        for (std::size_t i = 1; i < arrivals.size(); ++i) closest = std::min(closest, arrivals[i] - arrivals[i - 1]);
      }
      EXPECT_GE(closest, *bounds.gap());
      // The gap is not much too small either: sendings are cycles apart, so it is within one.
      EXPECT_LT(closest, *bounds.gap() + cluster.cycle().ns);
    }
  }
}

// The camera's lists are written 12.4 ms apart. One that just missed its slots is complete after 5 ms and the
// length of seven slots, so two may come 6.8 ms apart. By their slots alone it would be 4.4 ms.
TEST(ActivationBounds, OverFlexRayTheWriterSaysHowOften) {
  const model::Cluster cluster = over_flexray(false);
  const model::Task& fuse = task_of(cluster, "fusion", "fuse_camera");
  const auto near = [](std::int64_t found, double expected_us) {
    EXPECT_NEAR(static_cast<double>(found), expected_us * 1e3, 50e3);
  };
  near(*activation_bounds(cluster, fuse, kUnknown).gap(), 5'000 * 0.997 - 7 * 84);
  near(*activation_bounds(cluster, fuse, kKnown).gap(),
       (400 + 108 + 12'000) * 0.997 * 0.997 - (5'000 + 7 * 84) * 1.003);
  EXPECT_EQ(activation_bounds(cluster, fuse, kKnown).most(0), 1);
  EXPECT_EQ(activation_bounds(cluster, fuse, kKnown).most(8'000'000), 2);
  EXPECT_EQ(activation_bounds(cluster, fuse, kKnown).most(40'000'000), 4) << "and not nine, one each cycle";
}

TEST(ActivationBounds, OfWhatIsUnknownThereIsOne) {
  EXPECT_EQ(processor::ActivationBounds{}.most(1'000'000'000), 1);
  EXPECT_FALSE(processor::ActivationBounds{}.gap().has_value());
}

// Two nodes' tasks activate each other over FlexRay: each is taken to be as fast as the other's slots.
TEST(ActivationBounds, WritersMayWaitForEachOther) {
  model::Cluster cluster = over_flexray(false);
  const PduId to = *cluster.find_pdu("laser_objects"), back = *cluster.find_pdu("camera_objects");
  const auto answer = [&](const char* node, PduId reads, PduId writes) {
    model::Task task;
    task.name = "answer";
    task.activation = {model::ActivationKind::kMessage, {}, "in", kNoSensor, ""};
    task.best_case = Duration::microseconds(100);
    task.worst_case = Duration::microseconds(300);
    task.reads = {{"in", reads, model::kFlexRay, 0}};
    task.writes = {{"out", writes, model::kFlexRay, 0}};
    cluster.nodes[index_of(*cluster.find_node(node))].tasks = {task};
  };
  answer("laser_pre", back, to);
  answer("camera_pre", to, back);
  for (const char* node : {"laser_pre", "camera_pre"}) {
    const auto found = worst_responses(cluster, *cluster.find_node(node));
    ASSERT_TRUE(found.has_value());
    EXPECT_EQ((*found)[0].worst, Duration::microseconds(300));
    EXPECT_GT((*found)[0].gap, Duration::milliseconds(4));
  }
}

// A writer with its own error (a cycle of activations): the reader's findings do not follow it round.
TEST(ActivationBounds, OfAWriterThatGoesRoundAndRoundNothingIsKnown) {
  model::Cluster cluster = over_flexray(true);
  model::Task& preprocess = cluster.nodes[index_of(*cluster.find_node("camera_pre"))].tasks[0];
  preprocess.activation = {model::ActivationKind::kCompletion, {}, "", kNoSensor, preprocess.name};
  EXPECT_FALSE(worst_responses(cluster, *cluster.find_node("camera_pre")).has_value());
  EXPECT_EQ(activation_bounds(cluster, task_of(cluster, "fusion", "fuse_camera"), kKnown).all.size(), 1u);
}

TEST(Mutations, OfListsThatComeTooOftenOverFlexRay) {
  check::expect_named(
      {
          {"camera_often",
           check::inside("camera_pre", "best_case") + "12 ms",
           "$016 ms",
           {"worst_case: 2 ms", "nodes.fusion.tasks.fuse_camera.worst_case", "2 ms", "and the next may follow 3.49"}},
          {"fusing_long",
           check::inside("fuse_laser", "worst_case") + "2 ms([^~]*?deadline: )5 ms",
           "$017 ms$0215 ms",
           {"worst_case: 2 ms", "nodes.fusion.tasks.fuse_camera.worst_case", "2 ms",
            "before its next activation: it may end 9.5 ms"}},
      },
      "paper_free_flexray");
}

}  // namespace
}  // namespace ttf::schedules::analysis
