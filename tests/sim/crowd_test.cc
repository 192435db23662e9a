// The load the paper's system was dimensioned for: 25 objects, a minute.
#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <set>
#include <string>

#include "tests/sim/drive_fixture.h"

namespace ttf {
namespace {

using testing_support::Drive;

std::int64_t resident_kib() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with("VmRSS:")) return std::stoll(line.substr(6));
  return 0;
}

// Per true object the uses in which some image object was near it, after it had the time to be confirmed.
struct Coverage final : records::Sink {
  using records::Sink::on;
  std::map<ObjectId, std::pair<int, int>> seen;   // covered, of
  std::vector<records::FeatureObject> objects;
  TrueTime used_at{-1};
  std::int64_t after_warm_up_kib = 0, largest_kib = 0;

  void on(const records::FeatureUsed& used) override {
    objects.assign(used.objects.begin(), used.objects.end());
    used_at = used.stamp.true_time;
    const std::int64_t now = resident_kib();
    if (after_warm_up_kib == 0 && used_at > TrueTime{5'000'000'000}) after_warm_up_kib = now;
    largest_kib = std::max(largest_kib, now);
  }
  void on(const records::TruthState& truth) override {
    if (truth.at != used_at || truth.at < TrueTime{2'000'000'000}) return;
    auto& [covered, of] = seen[truth.object];
    ++of;
    for (const records::FeatureObject& object : objects)
      if (std::hypot(object.image.x - truth.x, object.image.y - truth.y) < 4.0) {
        ++covered;
        return;
      }
  }
};

TEST(Crowd, TwentyFiveObjectsForAMinute) {
  for (const auto strategy : testing_support::kStrategies) {
    Coverage coverage;
    const sim::DriveOutcome outcome = Drive("scenarios/crowd_25.yaml", strategy).run(coverage);
    ASSERT_EQ(coverage.seen.size(), 25u);
    for (const auto& [object, count] : coverage.seen) {
      EXPECT_GT(count.second, 1400);
      // Visible all the time, so tracked from its confirmation on; a track lost once is born anew within a second.
      EXPECT_GT(count.first, 0.97 * count.second)
          << nodes::name_of(strategy) << ", object " << index_of(object);
    }
    EXPECT_EQ(outcome.counts.slot_problems, 0u);
    EXPECT_EQ(outcome.counts.deadlines_missed, 0u);
    EXPECT_EQ(outcome.counts.torn_lists, 0u);
    EXPECT_EQ(outcome.counts.overwritten_lists, 0u);
    // Flat memory: what the first five seconds needed is enough for the minute.
    EXPECT_LT(coverage.largest_kib - coverage.after_warm_up_kib, 512) << nodes::name_of(strategy);
  }
}

}  // namespace
}  // namespace ttf
