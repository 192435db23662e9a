#include "sensors/mono_camera/lane_marks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace ttf::sensors::mono_camera {
namespace {

const std::vector<LaneMark> kMarks{{-5.25, 0.01, 0.002}, {-1.75, 0.01, 0.002}, {1.75, 0.01, 0.002}, {8.0, 0.0, 0.0}};

struct MarkList {
  std::vector<LaneMark> seen;
  std::vector<std::uint16_t> truth;
};
MarkList mark_list(const LaneMarkConfig& config, std::uint32_t sequence, std::size_t capacity = 8) {
  MarkList l;
  measure_lane_marks(config, kMarks, {1, 0, 3, sequence}, capacity, l.seen, l.truth);
  EXPECT_EQ(l.seen.size(), l.truth.size());
  return l;
}

TEST(LaneMarks, NoiseIsAsStatedAndFarMarksAreNotSeen) {
  LaneMarkConfig config;
  config.miss_probability = config.false_per_list = 0.0;
  constexpr std::uint32_t kLists = 2000;
  double offset = 0.0, heading = 0.0, curvature = 0.0, mean = 0.0;
  for (std::uint32_t k = 0; k < kLists; ++k) {
    const MarkList l = mark_list(config, k);
    ASSERT_EQ(l.truth, (std::vector<std::uint16_t>{0, 1, 2}));
    mean += l.seen[1].offset - kMarks[1].offset;
    offset += std::pow((l.seen[1].offset - kMarks[1].offset) / config.offset_sigma_m, 2);
    heading += std::pow((l.seen[1].heading - kMarks[1].heading) / config.heading_sigma_rad, 2);
    curvature += std::pow((l.seen[1].curvature - kMarks[1].curvature) / config.curvature_sigma_per_m, 2);
  }
  EXPECT_NEAR(mean / kLists, 0.0, 4.0 * config.offset_sigma_m / std::sqrt(kLists));
  for (const double squares : {offset, heading, curvature})
    EXPECT_NEAR(squares / kLists, 1.0, 4.0 * std::sqrt(2.0 / kLists));
}

TEST(LaneMarks, MissedAndFalseOnesAreAsOftenAsStated) {
  LaneMarkConfig config;
  config.miss_probability = 0.2;
  config.false_per_list = 0.3;
  constexpr std::uint32_t kLists = 4000;
  int seen = 0, others = 0;
  for (std::uint32_t k = 0; k < kLists; ++k) {
    const MarkList l = mark_list(config, k);
    const auto strange = static_cast<int>(std::count(l.truth.begin(), l.truth.end(), 0xffff));
    others += strange;
    seen += static_cast<int>(l.truth.size()) - strange;
    for (const LaneMark& mark : l.seen) EXPECT_LT(std::abs(mark.offset), config.widest_m + 0.5);
  }
  EXPECT_NEAR(seen / (3.0 * kLists), 0.8, 4.0 * std::sqrt(0.16 / (3.0 * kLists)));
  EXPECT_NEAR(others / double{kLists}, 0.3, 4.0 * std::sqrt(0.3 / kLists));
}

TEST(LaneMarks, ListsAreFilledFromTheFirstMarkOn) {
  LaneMarkConfig config;
  config.miss_probability = 0.0;
  config.false_per_list = 5.0;
  EXPECT_EQ(mark_list(config, 1, 2).truth, (std::vector<std::uint16_t>{0, 1}));
  const MarkList first = mark_list(config, 4), again = mark_list(config, 4), next = mark_list(config, 5);
  EXPECT_EQ(first.seen[0].offset, again.seen[0].offset);
  EXPECT_NE(first.seen[0].offset, next.seen[0].offset);
}

}  // namespace
}  // namespace ttf::sensors::mono_camera
