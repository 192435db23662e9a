// Colours and markers of sensors, by name, by order within their kind, and by the scenario's words.
#include "report/drawing/names.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "report/drawing/axes.h"

namespace ttf::report::drawing {
namespace {

std::string colour(const Names& names, int sensor) {
  return sensor_colour(names, SensorId(static_cast<std::uint8_t>(sensor)));
}
Marker marker(const Names& names, int sensor) {
  return sensor_marker(names, SensorId(static_cast<std::uint8_t>(sensor)));
}
Names of(const std::vector<std::string>& sensors) {
  Names names;
  names.sensors = sensors;
  return names;
}

TEST(SensorLooks, TheFirstOfAKindLooksAsItsKind) {
  const Names names = of({"laser", "stereo_camera", "radar", "sonar", "left", "right"});
  EXPECT_EQ(colour(names, 0), kVermilion);
  EXPECT_EQ(marker(names, 0), Marker::kCross);
  EXPECT_EQ(colour(names, 1), kBlue);
  EXPECT_EQ(marker(names, 1), Marker::kTriangle);
  EXPECT_EQ(colour(names, 2), kGreen);
  EXPECT_EQ(marker(names, 2), Marker::kDiamond);
  EXPECT_EQ(colour(names, 3), kPurple);
  EXPECT_EQ(colour(names, 4), kSkyBlue);
  EXPECT_EQ(colour(names, 5), kOrange);
  EXPECT_EQ(marker(names, 5), Marker::kDownTriangle);
  EXPECT_EQ(colour(names, 7), kSkyBlue) << "a sensor without a name";
}

TEST(SensorLooks, FurtherOnesOfAKindDiffer) {
  const Names names = of({"left_laser", "camera", "right_laser", "rear_laser", "rear_camera"});
  EXPECT_EQ(colour(names, 0), kVermilion);
  EXPECT_EQ(colour(names, 2), kOrange);
  EXPECT_EQ(marker(names, 2), Marker::kPlus);
  EXPECT_EQ(colour(names, 3), tint(kVermilion, 0.3));
  EXPECT_EQ(marker(names, 3), Marker::kCross);
  EXPECT_EQ(colour(names, 4), kSkyBlue);
  EXPECT_EQ(marker(names, 4), Marker::kDownTriangle);
}

TEST(SensorLooks, TheScenariosWordsCount) {
  Names names = of({"left", "right", "camera"});
  names.sensor_styles = {{"laser", "", ""}, {"laser", "purple", "diamond"}};
  EXPECT_EQ(look_of(names, SensorId{0}), SensorLook::kLaser);
  EXPECT_EQ(colour(names, 0), kVermilion);
  EXPECT_EQ(colour(names, 1), kPurple);
  EXPECT_EQ(marker(names, 1), Marker::kDiamond);
  EXPECT_EQ(colour(names, 2), kBlue);
  names.sensor_styles[1] = {"laser", "mauve", "star"};
  EXPECT_EQ(colour(names, 1), kOrange) << "words of a later version";
  EXPECT_EQ(marker(names, 1), Marker::kPlus);
}

}  // namespace
}  // namespace ttf::report::drawing
