// Moments of a scene from records, and the outlines of its parts.
#include "recording/scene/moments.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "recording/scene/geometry.h"

namespace ttf::recording::scene {
namespace {

using testing::ElementsAre;
using testing::SizeIs;

constexpr std::int64_t kMs = 1'000'000;
constexpr NodeId kFusion{5}, kFeature{6};

records::Stamp at(NodeId node, std::int64_t ms) { return {{ms * kMs}, {ms * kMs}, {ms * kMs}, node}; }

// Writes each moment down in words.
struct Reported final : Moments {
  std::vector<std::string> words;

 private:
  static std::string ms(TrueTime t) { return std::to_string(t.ns / kMs); }
  void truth(TrueTime t, std::span<const records::TruthState> states) override {
    words.push_back("truth " + ms(t) + " of " + std::to_string(states.size()));
  }
  void list(const SeenList& list) override {
    words.push_back("list " + ms(list.measured) + " of " + std::to_string(list.points.size()));
  }
  void image(TrueTime t, const records::ImageWritten&) override { words.push_back("image " + ms(t)); }
  void use(TrueTime t, const records::FeatureUsed&) override { words.push_back("use " + ms(t)); }
};

void observation(Moments& moments, std::int64_t ms, std::int64_t measured, std::uint32_t sequence, double x) {
  records::ObservationSeen seen;
  seen.stamp = at(kFusion, ms);
  seen.id = {SensorId{0}, sequence};
  seen.measured = {measured * kMs};
  seen.x = x;
  moments.on(seen);
}

void truth(Moments& moments, std::int64_t ms, int object, NodeId node) {
  records::TruthState state;
  state.at = {ms * kMs};
  state.object = static_cast<ObjectId>(object);
  state.node = node;
  moments.on(state);
}

TEST(SceneMoments, EachComesOnceAndWhole) {
  Reported reported;
  truth(reported, 10, 0, kFusion);
  truth(reported, 10, 1, kFusion);
  truth(reported, 10, 0, kFeature);  // another node's record of the same instant
  observation(reported, 20, 12, 3, 1.0);
  observation(reported, 20, 12, 3, std::numeric_limits<double>::infinity());
  observation(reported, 20, 8, 4, 1.0);  // another list at the same instant
  records::ImageWritten image;
  image.stamp = at(kFusion, 25);
  image.valid_at = {60 * kMs};
  reported.on(image);
  records::FeatureUsed use;
  use.stamp = at(kFeature, 61);
  reported.on(use);
  truth(reported, 62, 0, kFeature);
  reported.finish();
  EXPECT_THAT(reported.words,
              ElementsAre("truth 10 of 2", "list 12 of 1", "list 8 of 1", "image 60", "use 61", "truth 62 of 1"));
}

TEST(SceneMoments, AGlobalTimeFarFromItsRecordIsNotBelieved) {
  const records::Stamp stamp = at(kFusion, 100);
  EXPECT_EQ(instant_of(stamp, {(100 - 1999) * kMs}).ns, 0);  // before the drive
  EXPECT_EQ(instant_of(stamp, {150 * kMs}).ns, 150 * kMs);
  EXPECT_EQ(instant_of(stamp, {(100 + 2001) * kMs}).ns, 100 * kMs);
  EXPECT_EQ(instant_of(stamp, {std::numeric_limits<std::int64_t>::min()}).ns, 100 * kMs);
}

TEST(SceneGeometry, OutlinesStandWhereTheyMust) {
  const auto corners = rectangle({10.0, 2.0, std::numbers::pi / 2.0}, 4.0, 2.0);
  EXPECT_NEAR(corners[0].x, 9.0, 1e-12);  // the front left of a car that drives to the left
  EXPECT_NEAR(corners[0].y, 4.0, 1e-12);
  records::ImageObject object;
  object.x = 10.0;
  object.sigma_x = 0.5;
  object.sigma_y = 0.25;
  object.correlation_xy = 0.6;
  // Each point has the Mahalanobis distance of two sigma.
  for (const Point& p : ellipse(object)) {
    const double u = (p.x - 10.0) / 0.5, v = p.y / 0.25;
    EXPECT_NEAR((u * u - 2.0 * 0.6 * u * v + v * v) / (1.0 - 0.6 * 0.6), 4.0, 1e-9);
  }
  object.sigma_x = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(ellipse(object), SizeIs(0));
  // A field to the left from the vehicle's front: its middle is at its longest range, across the vehicle.
  const std::vector<Point> field = mounted({3.5, 0.5, std::numbers::pi / 2.0}, edge({1.0, 0.0, 120.0}));
  EXPECT_NEAR(field[16].x, 3.5, 1e-12);
  EXPECT_NEAR(field[16].y, 120.5, 1e-12);
  EXPECT_NEAR(field.back().x, 3.5, 1e-12);  // and it ends at the sensor
}

}  // namespace
}  // namespace ttf::recording::scene
