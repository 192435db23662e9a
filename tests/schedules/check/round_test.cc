// Clusters with another round of cycles than the 64 of FlexRay 2.1.
#include <gtest/gtest.h>

#include <algorithm>
#include <tuple>

#include "core/random.h"
#include "tests/schedules/cluster_file.h"
#include "tests/schedules/small_cluster.h"
#include "tests/support/patterns.h"

namespace ttf::schedules::check {
namespace {

std::string counting_to(int last) {
  return support::replaced(shipped_text("paper_synchronised"), "gCycleCountMax: 63",
                           "gCycleCountMax: " + std::to_string(last));
}

std::vector<Finding> findings_of(const std::string& text) {
  try {
    return check(file::parse_cluster(text, "cluster.yaml"));
  } catch (const InputError& error) {
    return error.findings();
  }
}

TEST(Round, RepetitionsDivideIt) {
  EXPECT_TRUE(findings_of(counting_to(47)).empty());  // repetitions of up to 16 cycles
  const auto findings = findings_of(counting_to(59));
  ASSERT_FALSE(findings.empty());
  for (const Finding& one : findings) {
    EXPECT_TRUE(one.key.ends_with(".repetition")) << one.sentence();
    const bool of_a_frame = one.key.starts_with("frames");
    EXPECT_EQ(one.expected, std::string("must be one of ") +
                                (of_a_frame ? "1, 2, 4, 5, 10, 20" : "1, 2, 3, 4, 5, 6, 10, 12, 15, 20, 30, 60") +
                                ": repetitions divide gCycleCountMax + 1 = 60");
  }
}

// A wrong count is the one mistake: repetitions are not blamed for it.
TEST(Round, AWrongCountIsSaidOnce) {
  for (const auto& [last, words] : {std::pair{62, "must be odd"}, {5, "7..63"}, {64, "7..63"}, {-1, "7..63"}}) {
    const auto findings = findings_of(counting_to(last));
    ASSERT_EQ(findings.size(), 1u) << last;
    EXPECT_EQ(findings[0].key, "flexray.gCycleCountMax");
    EXPECT_GT(findings[0].line, 0);
    EXPECT_NE(findings[0].expected.find(words), std::string::npos) << findings[0].sentence();
  }
}

// Eight cycles of 5 ms separate stamps of up to 35 ms, ten cycles of up to 43.75 ms.
TEST(Round, IsLongEnoughForTheStampsOfMeasurements) {
  for (const auto& [execution_ms, last, fits] :
       {std::tuple{20, 7, true}, {36, 7, false}, {30, 9, true}, {45, 9, false}, {300, 63, true}}) {
    model::Cluster cluster = small(true);
    cluster.flexray.gCycleCountMax = last;
    model::Task& measure = cluster.nodes[0].tasks[0];
    measure.best_case = measure.worst_case = Duration::milliseconds(execution_ms);
    ClusterFindings found(cluster);
    check_round(cluster, found);
    const auto findings = found.take();
    ASSERT_EQ(findings.empty(), fits) << execution_ms << " ms, " << last;
    if (fits) continue;
    EXPECT_EQ(findings[0].key, "flexray.gCycleCountMax");
    EXPECT_NE(findings[0].expected.find("stamps are told apart"), std::string::npos) << findings[0].sentence();
  }
}

// Tasks of one processor overlap if any of their instances do.
TEST(Round, TasksOverlapIfAnyInstancesDo) {
  RandomStream draw({1, 1, Purpose::kTest, 60, 0});
  int overlaps = 0;
  for (int set = 0; set < 500; ++set) {
    model::Cluster cluster = small(true);
    cluster.flexray.gCycleCountMax = 59;
    std::vector<int> allowed{2, 3, 4, 5, 6, 10, 12, 15, 20};
    std::vector<model::Task>& tasks = cluster.nodes[1].tasks;
    const std::int64_t cycle = cluster.cycle().ns;
    for (model::Task& task : tasks) {
      const int repetition =
          allowed[static_cast<std::size_t>(draw.integer(0, static_cast<std::int64_t>(allowed.size()) - 1))];
      const auto base = static_cast<int>(draw.integer(0, repetition - 1));
      task.activation.at = {base, repetition, Macroticks{draw.integer(0, 4999)}};
      task.best_case = task.worst_case = Duration::microseconds(draw.integer(1, 8'000));
      task.deadline = {cycle * repetition};
    }
    bool overlap = false;
    const auto begins = [&](const model::Task& task, std::int64_t instance) {
      const model::CycleInstant& at = task.activation.at;
      return time_of(cluster.flexray, at.base_cycle + instance * at.repetition, at.offset).ns;
    };
    for (std::int64_t a = 0; a < 120; ++a)
      for (std::int64_t b = 0; b < 120; ++b) {
        const std::int64_t from = begins(tasks[0], a), to = begins(tasks[1], b);
        overlap = overlap || (from < to + tasks[1].worst_case.ns && to < from + tasks[0].worst_case.ns);
      }
    ClusterFindings found(cluster);
    check_tasks(cluster, found);
    const auto all = found.take();
    const bool said = std::any_of(all.begin(), all.end(), [](const Finding& one) {
      return one.expected.find("overlaps") != std::string::npos && one.expected.find("itself") == std::string::npos;
    });
    EXPECT_EQ(said, overlap) << "set " << set;
    overlaps += overlap ? 1 : 0;
  }
  EXPECT_GT(overlaps, 50);
  EXPECT_LT(overlaps, 450);
}

}  // namespace
}  // namespace ttf::schedules::check
