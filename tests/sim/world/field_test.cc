// Objects in rows: each object's place, and the refused values.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "tests/sim/world/drives.h"

namespace ttf::sim::world {
namespace {

std::string finding_of(const std::string& text) {
  try {
    world_from(text);
  } catch (const InputError& error) {
    return error.findings().front().sentence();
  }
  return "";
}

TEST(Field, RowsAreFilledOneAfterTheOtherFromTheirMiddle) {
  // Within 45 degrees: at 10 m two to either side, at 14 m again two, which begin half a place aside.
  const WorldConfig world = world_from(
      "field: {objects: 9, nearest: 10, row: 4, across: 5, half_angle: 0.7854, speed: 1.5, length: 0.6, width: 0.4}");
  const double x[] = {10, 10, 10, 10, 10, 14, 14, 14, 14}, y[] = {0, -5, 5, -10, 10, 2.5, -2.5, 7.5, -7.5};
  ASSERT_EQ(world.objects.size(), 9u);
  for (std::size_t i = 0; i < 9; ++i) {
    EXPECT_DOUBLE_EQ(world.objects[i].x, x[i]) << i;
    EXPECT_DOUBLE_EQ(world.objects[i].y, y[i]) << i;
    EXPECT_EQ(world.objects[i].speed, 1.5);
    EXPECT_EQ(world.objects[i].length, 0.6);
    EXPECT_EQ(world.objects[i].width, 0.4);
  }
}

TEST(Field, StandsBehindTheObjectsWithNamesAndIsCountedWithThem) {
  const std::string text = "objects: [{name: car, x: 10, y: 0}]\nfield: {objects: 3}\n";
  const WorldConfig all = world_from(text), two = world_from(text + "object_count: 2\n");
  ASSERT_EQ(all.objects.size(), 4u);
  EXPECT_EQ(all.objects[0].name, "car");
  ASSERT_EQ(two.objects.size(), 2u);
  EXPECT_EQ(two.objects[1].name, all.objects[1].name);
  EXPECT_NE(finding_of(text + "object_count: 5\n").find("1..4"), std::string::npos);
}

TEST(Field, AThousandFitTheShippedSquareWithoutTouching) {
  const WorldConfig square = drive("thousand");
  ASSERT_EQ(square.objects.size(), 1000u);
  double nearest = 1e9;
  for (std::size_t a = 0; a < square.objects.size(); ++a)
    for (std::size_t b = 0; b < a; ++b)
      nearest = std::min(
          nearest, std::hypot(square.objects[a].x - square.objects[b].x, square.objects[a].y - square.objects[b].y));
  EXPECT_DOUBLE_EQ(nearest, 4.0);
}

TEST(Field, RefusesMoreThanThereIsRoomFor) {
  EXPECT_EQ(finding_of("field: {objects: 12, nearest: 490, row: 10, half_angle: 0.0}"),
            "test.yaml:1: field.objects = 12: must be at most 1: rows end 500 m away");
  EXPECT_NE(finding_of("field: {objects: 5001}").find("1..5000"), std::string::npos);
  EXPECT_NE(finding_of("field: {nearest: 10}").find("missing"), std::string::npos);
  EXPECT_NE(finding_of("field: {objects: 3, depth: 2}").find("depth"), std::string::npos);
}

}  // namespace
}  // namespace ttf::sim::world
