// A track's unfiltered content: sums of scores by class, and the newest third axis.
#include <gtest/gtest.h>

#include "fusion/tracks/unfiltered.h"

namespace ttf::fusion::tracks {
namespace {

sensors::Observation reported(sensors::ClassId what, double score) {
  sensors::Observation observation;
  observation.class_id = what;
  observation.score = score;
  return observation;
}

TEST(Unfiltered, TheLargestSumCountsAndOfEqualOnesTheFirst) {
  Unfiltered unfiltered;
  EXPECT_EQ(unfiltered.classes.best(), sensors::kNoClass);
  EXPECT_EQ(unfiltered.classes.share(), 0.0);
  carry(unfiltered, reported(sensors::ClassId{3}, 0.0));
  EXPECT_EQ(unfiltered.classes.best(), sensors::kNoClass) << "a score of zero tells nothing";
  carry(unfiltered, reported(sensors::ClassId{15}, 0.5));
  EXPECT_EQ(unfiltered.classes.best(), sensors::ClassId{15});
  carry(unfiltered, reported(sensors::ClassId{2}, 0.25));
  carry(unfiltered, reported(sensors::ClassId{2}, 0.25));
  EXPECT_EQ(unfiltered.classes.best(), sensors::ClassId{2}) << "of equal sums the first";
  EXPECT_EQ(unfiltered.classes.share(), 0.5);
  carry(unfiltered, reported(sensors::kNoClass, 7.0));
  EXPECT_EQ(unfiltered.classes.share(), 0.5);
  carry(unfiltered, reported(sensors::ClassId{15}, 1.0));
  EXPECT_EQ(unfiltered.classes.best(), sensors::ClassId{15});
  EXPECT_EQ(unfiltered.classes.share(), 0.75);
}

TEST(Unfiltered, TheThirdAxisIsTheNewestThatWasMeasured) {
  Unfiltered unfiltered;
  sensors::Observation observation;
  observation.third = {0.5, 1.5, true, true};
  carry(unfiltered, observation);
  observation.third = {0.75, 0.0, true, false};
  carry(unfiltered, observation);
  observation.third = {};
  carry(unfiltered, observation);
  EXPECT_TRUE(unfiltered.third.has_z && unfiltered.third.has_height);
  EXPECT_EQ(unfiltered.third.z, 0.75);
  EXPECT_EQ(unfiltered.third.height, 1.5);
}

}  // namespace
}  // namespace ttf::fusion::tracks
