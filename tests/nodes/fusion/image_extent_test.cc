// The image's object sizes against the truth: within their stated uncertainty, over the paper's drives and
// crossing cars.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "tests/sim/drives/drive_fixture.h"

namespace ttf::nodes::fusion {
namespace {

using sim::drives::Drive;

// A size in the image, from the instant on at which drives are judged.
struct Reported {
  int uses = 0, known = 0, outside_3 = 0;
  double error_squares = 0.0, normalised_squares = 0.0;
  void add(bool is_known, double error, double sigma) {
    ++uses;
    if (!is_known) return;
    ++known;
    error_squares += error * error;
    normalised_squares += error * error / (sigma * sigma);
    outside_3 += std::abs(error) > 3.0 * sigma;
  }
  double rms() const { return std::sqrt(error_squares / known); }
};
struct Sizes final : recording::records::Sink {
  using recording::records::Sink::on;
  TrueTime from{};
  std::vector<recording::records::FeatureObject> objects;
  TrueTime used_at{-1};
  Reported length, width;

  void on(const recording::records::FeatureUsed& used) override {
    objects.assign(used.objects.begin(), used.objects.end());
    used_at = used.stamp.true_time;
  }
  void on(const recording::records::TruthState& truth) override {
    if (truth.at != used_at || truth.at < from) return;
    for (const recording::records::FeatureObject& object : objects) {
      const recording::records::ImageObject& image = object.image;
      if (std::hypot(image.x - truth.x, image.y - truth.y) > 3.0) continue;
      length.add(image.sigma_length <= 0.25, image.length - truth.length, image.sigma_length);
      width.add(image.sigma_width <= 0.08, image.width - truth.width, image.sigma_width);
    }
  }
};

Sizes driven(Drive drive) {
  Sizes sizes;
  sizes.from = sim::engine::kFirstCycle + Duration::milliseconds(800);
  // The start varies, so that the laser's raster meets the car elsewhere.
  for (std::uint64_t seed = 1; seed <= 24; ++seed) {
    drive.scenario.world.objects[0].x += 0.07;
    drive.run(sizes, seed);
  }
  return sizes;
}

// Sizes hardly change from use to use, so samples are far from independent.
void expect_honest(const Reported& reported) {
  EXPECT_GT(reported.uses, 500);
  EXPECT_LE(reported.normalised_squares, 1.6 * reported.known + 10.0);
  EXPECT_LE(reported.outside_3, 0.01 * reported.uses);
}

class ImageExtent : public testing::TestWithParam<ttf::fusion::strategies::StrategyKind> {};
INSTANTIATE_TEST_SUITE_P(All, ImageExtent, testing::ValuesIn(ttf::fusion::strategies::kAllStrategies),
                         [](const auto& kind) { return std::string(name_of(kind.param)); });

TEST_P(ImageExtent, IsHonestForACarThatDrivesAhead) {
  const Sizes sizes = driven(Drive("scenarios/paper_scenario1.yaml", GetParam()));
  expect_honest(sizes.length);
  expect_honest(sizes.width);
  EXPECT_EQ(sizes.width.known, sizes.width.uses);
  EXPECT_LT(sizes.width.rms(), 0.1);
  EXPECT_LT(sizes.length.known, sizes.length.uses / 20) << "nobody sees how long it is";
}

TEST_P(ImageExtent, IsHonestForACarThatComesAndTurnsOff) {
  const Sizes sizes = driven(Drive("scenarios/paper_scenario2.yaml", GetParam()));
  expect_honest(sizes.length);
  expect_honest(sizes.width);
  EXPECT_LT(sizes.width.rms(), 0.1);
  EXPECT_GT(sizes.length.known, 0);
  EXPECT_LT(sizes.length.rms(), 0.5);
}

// The camera sees a crossing car's side. The laser derives the car's width from its front.
TEST_P(ImageExtent, IsHonestForACarThatCrosses) {
  for (const bool from_left : {false, true}) {
    Drive drive("scenarios/paper_scenario1.yaml", GetParam());
    sim::world::ObjectConfig& car = drive.scenario.world.objects[0];
    car.segments.clear();
    car.x = 22.0;
    car.y = from_left ? 14.0 : -14.0;
    car.heading = from_left ? -1.2 : 1.5707963;
    car.speed = 8.0;
    const Sizes sizes = driven(drive);
    expect_honest(sizes.length);
    expect_honest(sizes.width);
    EXPECT_EQ(sizes.length.known, sizes.length.uses);
    EXPECT_GT(sizes.width.known, sizes.width.uses / 2);
    EXPECT_LT(sizes.length.rms(), 0.1);
    EXPECT_LT(sizes.width.rms(), 0.15);
  }
}

}  // namespace
}  // namespace ttf::nodes::fusion
