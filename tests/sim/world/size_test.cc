// Sizes as written, or drawn once a drive.
#include "sim/world/size.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "tests/sim/world/drives.h"
#include "tests/support/refusals.h"

namespace ttf::sim::world {
namespace {

using testing::HasSubstr;

std::string with_size(const std::string& size) {
  return "acceleration_noise: 2\nsize: " + size +
         "\nobjects: [{name: a, x: 20, y: 0, speed: 5}, {name: b, x: 40, y: 0, length: 4, width: 2}]\n";
}

Size size_of(const WorldConfig& config, std::uint64_t seed, std::uint32_t replication, std::uint16_t object) {
  const ObjectState state = World(config, seed, replication).state_of(ObjectId{object}, at_ms(500));
  return {state.length, state.width};
}

// Means, standard deviations and correlation of many draws.
struct Moments {
  double length = 0, width = 0, length_sigma = 0, width_sigma = 0, correlation = 0;
  double shortest = 1e9, longest = 0, narrowest = 1e9, widest = 0;
};
Moments moments_of(const SizeConfig& config, std::uint32_t draws) {
  double l = 0, w = 0, ll = 0, ww = 0, lw = 0;
  Moments m;
  for (std::uint32_t r = 0; r < draws; ++r) {
    const Size size = drawn_size(config, {}, {3, r, ObjectId{2}});
    l += size.length;
    w += size.width;
    ll += size.length * size.length;
    ww += size.width * size.width;
    lw += size.length * size.width;
    m.shortest = std::min(m.shortest, size.length);
    m.longest = std::max(m.longest, size.length);
    m.narrowest = std::min(m.narrowest, size.width);
    m.widest = std::max(m.widest, size.width);
  }
  m.length = l / draws;
  m.width = w / draws;
  m.length_sigma = std::sqrt(ll / draws - m.length * m.length);
  m.width_sigma = std::sqrt(ww / draws - m.width * m.width);
  m.correlation = (lw / draws - m.length * m.width) / (m.length_sigma * m.width_sigma);
  return m;
}

constexpr std::uint32_t kDraws = 20'000;
// Over n draws a mean spreads by sigma / sqrt(n). A standard deviation spreads by sigma / sqrt(2 n). A correlation c
// spreads by (1 - c^2) / sqrt(n). Each is allowed four times as much.
const double kSpread = 4.0 / std::sqrt(kDraws);

TEST(Sizes, AreThoseOfTheFileUnlessDrawn) {
  for (const char* size : {"{}", "{draw: nominal, normal: {length: 5}}"}) {
    const WorldConfig config = world_from(with_size(size));
    EXPECT_EQ(size_of(config, 1, 0, 0).length, 4.39) << size;
    EXPECT_EQ(size_of(config, 1, 0, 0).width, 1.79) << size;
    EXPECT_EQ(size_of(config, 1, 0, 1).length, 4.0) << size;
    EXPECT_EQ(size_of(config, 1, 0, 1).width, 2.0) << size;
  }
}

TEST(Sizes, AreDrawnOnceADriveForEachObject) {
  const WorldConfig config = world_from(with_size("{draw: normal}"));
  const Size first = size_of(config, 1, 0, 0);
  EXPECT_EQ(first.length, size_of(config, 1, 0, 0).length);
  EXPECT_NE(first.length, size_of(config, 2, 0, 0).length);
  EXPECT_NE(first.length, size_of(config, 1, 1, 0).length);
  EXPECT_NE(first.length, size_of(config, 1, 0, 1).length);
  const World world(config, 1, 0);
  EXPECT_EQ(world.state_of(ObjectId{0}, at_ms(0)).length, world.state_of(ObjectId{0}, at_ms(1500)).length);
}

TEST(Sizes, MoveNoOtherDraw) {
  const World nominal(world_from(with_size("{}")), 5, 7);
  for (const char* size : {"{draw: normal}", "{draw: uniform}"}) {
    const World drawn(world_from(with_size(size)), 5, 7);
    for (const std::uint16_t object : {std::uint16_t{0}, std::uint16_t{1}}) {
      const ObjectState is = drawn.state_of(ObjectId{object}, at_ms(900));
      const ObjectState was = nominal.state_of(ObjectId{object}, at_ms(900));
      EXPECT_EQ(is.x, was.x);
      EXPECT_EQ(is.speed, was.speed);
      EXPECT_NE(is.length, was.length);
    }
  }
}

TEST(Sizes, TheNormalDrawHasTheMomentsOfCars93) {
  SizeConfig config;
  config.draw = SizeDraw::kNormal;
  const Moments m = moments_of(config, kDraws);
  EXPECT_NEAR(m.length, 4.65, kSpread * 0.37);
  EXPECT_NEAR(m.width, 1.76, kSpread * 0.10);
  EXPECT_NEAR(m.length_sigma, 0.37, kSpread * 0.37 / std::sqrt(2.0));
  EXPECT_NEAR(m.width_sigma, 0.10, kSpread * 0.10 / std::sqrt(2.0));
  EXPECT_NEAR(m.correlation, 0.82, kSpread * (1.0 - 0.82 * 0.82));
}

// Limits a standard deviation from the mean: a normal one cut there has 0.5396 of its standard deviation.
TEST(Sizes, TheNormalDrawKeepsWithinItsLimits) {
  SizeConfig config;
  config.draw = SizeDraw::kNormal;
  config.correlation = 0.0;
  config.normal = {4.65 - 0.37, 4.65 + 0.37, 1.0, 3.0};
  const Moments m = moments_of(config, kDraws);
  EXPECT_GE(m.shortest, config.normal.shortest);
  EXPECT_LE(m.longest, config.normal.longest);
  EXPECT_NEAR(m.length, 4.65, kSpread * 0.2);
  EXPECT_NEAR(m.length_sigma / 0.37, 0.5396, 0.02);
  EXPECT_NEAR(m.width_sigma, 0.10, 0.004) << "the other value is not cut";
}

TEST(Sizes, TheUniformDrawFillsItsRanges) {
  SizeConfig config;
  config.draw = SizeDraw::kUniform;
  const Moments m = moments_of(config, kDraws);
  EXPECT_GE(m.shortest, 3.79);
  EXPECT_LT(m.longest, 5.01);
  EXPECT_LT(m.shortest, 3.80);
  EXPECT_GT(m.longest, 5.00);
  EXPECT_GE(m.narrowest, 1.59);
  EXPECT_LT(m.widest, 2.01);
  EXPECT_NEAR(m.length, 4.40, kSpread * 0.36);
  EXPECT_NEAR(m.length_sigma, 1.22 / std::sqrt(12.0), 0.01);
  EXPECT_NEAR(m.width_sigma, 0.42 / std::sqrt(12.0), 0.004);
  EXPECT_NEAR(m.correlation, 0.0, kSpread);
}

TEST(Sizes, AnObjectsOwnKeyReplacesTheWorlds) {
  const WorldConfig config = world_from(
      "size: {draw: uniform, uniform: {shortest: 8, longest: 9, narrowest: 2, widest: 2.5}}\n"
      "objects: [{name: a, x: 20, y: 0, size: {draw: nominal}}, {name: b, x: 40, y: 0, size: {draw: uniform}}]\n"
      "field: {objects: 2}\n");
  EXPECT_EQ(size_of(config, 1, 0, 0).length, 4.39);
  EXPECT_LT(size_of(config, 1, 0, 1).length, 5.01);
  EXPECT_NE(size_of(config, 1, 0, 1).length, 4.39);
  EXPECT_GE(size_of(config, 1, 0, 2).length, 8.0);
  EXPECT_GE(size_of(config, 1, 0, 3).length, 8.0);
  EXPECT_NE(size_of(config, 1, 0, 2).length, size_of(config, 1, 0, 3).length);
}

std::string mistake_in(const std::string& size) {
  return support::refusal_of([&] { world_from(with_size(size)); }, "accepted");
}

TEST(Sizes, MistakesAreReported) {
  EXPECT_THAT(mistake_in("{draw: cars93}"), HasSubstr("size.draw = cars93: must be one of nominal, normal, uniform"));
  EXPECT_THAT(mistake_in("{normal: {length: 3.2}}"),
              HasSubstr("size.normal.length = 3.2: must lie `length_sigma` or more within `shortest` and `longest`"));
  EXPECT_THAT(mistake_in("{normal: {width_sigma: 0.7}}"), HasSubstr("must lie `width_sigma` or more"));
  EXPECT_THAT(mistake_in("{uniform: {shortest: 5.5}}"),
              HasSubstr("size.uniform.shortest = 5.5: must be at most `longest`"));
  EXPECT_THAT(mistake_in("{uniform: {narrowest: 2.5, widest: 2.4}}"), HasSubstr("must be at most `widest`"));
  EXPECT_THAT(mistake_in("{normal: {correlation: 1.1}}"), HasSubstr("must be a number -1..1"));
}

}  // namespace
}  // namespace ttf::sim::world
