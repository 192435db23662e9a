#include "sensors/mono_camera/mark_memory.h"

#include <gtest/gtest.h>

#include <vector>

namespace ttf::sensors::mono_camera {
namespace {

TEST(MarkMemory, LastingMarksBecomeValid) {
  MarkMemory memory(8);
  for (int list = 1; list <= 7; ++list) {
    // It drifts by 0.1 m from list to list; another one is seen once.
    std::vector<SeenMark> marks{{1.8 + 0.1 * list, 0.01, 0.0}};
    if (list == 4) marks.push_back({-3.0, 0.0, 0.0});
    memory.judge(marks);
    EXPECT_DOUBLE_EQ(marks[0].validity, list < 5 ? 0.2 * list : 1.0) << list;
    if (list == 4) {
      EXPECT_DOUBLE_EQ(marks[1].validity, 0.2);
    }
  }
}

TEST(MarkMemory, AMissedListBeginsAnew) {
  MarkMemory memory(8);
  std::vector<SeenMark> mark{{1.8, 0.01, 0.0}}, none, turned{{1.8, 0.2, 0.0}};
  memory.judge(mark);
  memory.judge(mark);
  EXPECT_DOUBLE_EQ(mark[0].validity, 0.4);
  memory.judge(turned);
  EXPECT_DOUBLE_EQ(turned[0].validity, 0.2) << "it leads elsewhere";
  memory.judge(none);
  memory.judge(mark);
  EXPECT_DOUBLE_EQ(mark[0].validity, 0.2);
}

}  // namespace
}  // namespace ttf::sensors::mono_camera
