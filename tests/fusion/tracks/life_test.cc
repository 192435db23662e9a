// The counts of a track's lists.
#include "fusion/tracks/life.h"

#include <gtest/gtest.h>

#include <cstdint>

namespace ttf::fusion::tracks {
namespace {

Life after(unsigned pattern, int lists) {
  Life life;
  for (int k = 0; k < lists; ++k) count_newest(life, (pattern >> k & 1u) != 0);
  return life;
}

// Every pattern of hits and misses over eight lists of which one, at every place, comes last.
TEST(Life, ALateListGivesTheCountsOfArrivalInOrder) {
  constexpr int kLists = 8;
  for (unsigned pattern = 0; pattern < 1u << kLists; ++pattern)
    for (int late = 0; late < kLists; ++late) {
      const unsigned before = pattern & ((1u << late) - 1u), behind = pattern >> (late + 1) << late;
      Life life = after(before | behind, kLists - 1);
      count_late(life, kLists - 1 - late, (pattern >> late & 1u) != 0);
      const Life in_order = after(pattern, kLists);
      ASSERT_EQ(life.hits, in_order.hits) << pattern << ", " << late;
      ASSERT_EQ(life.lists, in_order.lists);
      ASSERT_EQ(life.misses, in_order.misses) << pattern << ", " << late;
    }
}

TEST(Life, AListBeyondAllHitsCountsAsOne) {
  Life life = after(0xffu, 8);
  count_late(life, 40, false);
  EXPECT_EQ(life.hits, 0xffu);
  EXPECT_EQ(life.lists, 9);
  EXPECT_EQ(life.misses, 0);
}

}  // namespace
}  // namespace ttf::fusion::tracks
