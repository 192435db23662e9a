#include "fusion/timeline.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "core/random.h"
#include "tests/fusion/scans.h"

namespace ttf::fusion {
namespace {

using testing_support::position;
using testing_support::same_bits;
using testing_support::scan;

// Two objects, two sensors; scans 2 and 3 are of the same instant, so the order of ties matters.
//   t [ms]   0    40    80    80   120   160
//   sensor   0     1     0     1     1     0
std::vector<StoredScan> six_scans() {
  RandomStream random({1, 0, Purpose::kTest, 0, 0});
  const auto objects = [&](double t) {
    return std::vector{position(20 + 5 * t + 0.2 * random.normal(), 0.2 * random.normal()),
                       position(30 - 4 * t + 0.2 * random.normal(), 6 + 0.2 * random.normal())};
  };
  return {scan(0, 0, 0, objects(0)),     scan(1, 0, 40, objects(0.04)),  scan(0, 1, 80, objects(0.08)),
          scan(1, 1, 80, objects(0.08)), scan(1, 2, 120, objects(0.12)), scan(0, 2, 160, objects(0.16))};
}

TEST(Timeline, EveryOrderOfArrivalGivesTheBitsOfTheChronologicalOne) {
  const std::vector<StoredScan> scans = six_scans();
  Timeline in_order({}, 16);
  for (const StoredScan& s : scans) EXPECT_EQ(in_order.insert(s.view()), Timeline::Insertion::kInOrder);
  EXPECT_EQ(in_order.current().tracks.size(), 2u);
  std::vector<std::size_t> order(scans.size());
  std::iota(order.begin(), order.end(), 0);
  int permutations = 0;
  do {
    Timeline timeline({}, 16);
    for (const std::size_t s : order) timeline.insert(scans[s].view());
    ASSERT_TRUE(same_bits(timeline.current(), in_order.current())) << "permutation " << permutations;
    ++permutations;
  } while (std::next_permutation(order.begin(), order.end()));
  EXPECT_EQ(permutations, 720);
}

// Late scans re-open association: two crossing objects and clutter, forty scans shuffled.
TEST(Timeline, ShuffledLongRunsToo) {
  RandomStream random({2, 0, Purpose::kTest, 0, 0});
  std::vector<StoredScan> scans;
  for (std::uint32_t k = 0; k < 40; ++k) {
    const double t = 0.05 * k;
    std::vector<Observation> list{
        position(20 + 6 * t + 0.3 * random.normal(), -3 + 3 * t + 0.3 * random.normal(), 0.3),
        position(32 - 6 * t + 0.3 * random.normal(), 3 - 3 * t + 0.3 * random.normal(), 0.3)};
    if (random.uniform() < 0.4) list.push_back(position(random.uniform(10, 40), random.uniform(-8, 8)));
    scans.push_back(scan(static_cast<std::uint8_t>(k % 3), k / 3, 50 * k, std::move(list)));
  }
  Timeline in_order({}, 16);
  for (const StoredScan& s : scans) in_order.insert(s.view());
  for (int shuffle = 0; shuffle < 100; ++shuffle) {
    std::vector<std::size_t> order(scans.size());
    std::iota(order.begin(), order.end(), 0);
    for (std::size_t i = order.size(); i-- > 1;)
      std::swap(order[i], order[static_cast<std::size_t>(random.integer(0, static_cast<std::int64_t>(i)))]);
    Timeline timeline({}, 16);
    for (const std::size_t s : order) timeline.insert(scans[s].view());
    ASSERT_TRUE(same_bits(timeline.current(), in_order.current())) << "shuffle " << shuffle;
  }
}

// The history holds three scans: what is older than the base cannot be taken in, and changes nothing.
TEST(Timeline, OlderThanTheHistoryIsRefused) {
  TrackerConfig config;
  config.history_scans = 3;
  Timeline timeline(config, 16);
  for (std::uint32_t k = 1; k <= 6; ++k) timeline.insert(scan(0, k, 100 * k, {position(20, 0)}).view());
  TrackSet before(timeline.current().tracks.size());
  before.assign(timeline.current());
  EXPECT_EQ(timeline.insert(scan(1, 0, 150, {position(25, 5)}).view()), Timeline::Insertion::kTooOld);
  EXPECT_TRUE(same_bits(timeline.current(), before));
  EXPECT_EQ(timeline.insert(scan(1, 1, 450, {position(25, 5)}).view()), Timeline::Insertion::kLate);
  EXPECT_FALSE(same_bits(timeline.current(), before));
}

}  // namespace
}  // namespace ttf::fusion
