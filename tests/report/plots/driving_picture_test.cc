// The closed loop over time: lines end where the truth does, and at a collision.
#include "report/plots/driving_picture.h"

#include <gtest/gtest.h>

#include <string>

namespace ttf::report::plots {
namespace {

namespace records = recording::records;

constexpr const char* kTruth = "class=\"truth\"";

std::size_t count(const std::string& text, const std::string& word) {
  std::size_t found = 0;
  for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) ++found;
  return found;
}

// Reports the truth from `from` to `to`, a hundred times a second. The object ahead is `gap` ahead of the front and comes nearer.
void report(DrivingPicture& picture, double from, double to, double gap, double closing) {
  for (int i = 0; i < static_cast<int>((to - from) * 100.0); ++i) {
    const TrueTime at{static_cast<std::int64_t>((from + 0.01 * i) * 1e9)};
    records::EgoTruth ego;
    ego.at = at;
    ego.vx = 10.0;
    picture.on(ego);
    records::TruthState object;
    object.at = at;
    object.x = 3.4 + 2.0 + gap - closing * 0.01 * i;  // its middle, with a length of 4 m
    object.length = 4.0;
    object.width = 1.8;
    object.speed = 10.0 - closing;
    picture.on(object);
  }
}

DrivingOptions options() { return {"A drive", TrueTime{}, TrueTime{10'000'000'000}, 3.4, 1.8, {}}; }

TEST(DrivingPicture, ALineEndsWhereTheTruthDoes) {
  DrivingPicture whole(options()), parted(options());
  report(whole, 0.0, 4.0, 30.0, 0.0);
  report(parted, 0.0, 2.0, 30.0, 0.0);
  report(parted, 3.0, 4.0, 30.0, 0.0);
  // Gap, two speeds, acceleration.
  EXPECT_EQ(count(whole.svg(), kTruth), 4U);
  EXPECT_EQ(count(parted.svg(), kTruth), 8U);
}

TEST(DrivingPicture, ACollisionEndsTheGap) {
  DrivingPicture picture(options()), without(options());
  report(picture, 0.0, 4.0, 10.0, 5.0);
  report(without, 0.0, 4.0, 30.0, 5.0);
  const std::string collided = picture.svg(), passed = without.svg();
  EXPECT_EQ(count(collided, ">collision<"), 1U);  // in the legend
  EXPECT_EQ(count(passed, ">collision<"), 0U);
  EXPECT_EQ(count(collided, "class=\"collision\""), 3U);  // one in each panel
}

TEST(DrivingPicture, TheLegendHasTheWarningsOfTheDrive) {
  DrivingPicture picture(options());
  report(picture, 0.0, 4.0, 30.0, 0.0);
  EXPECT_EQ(count(picture.svg(), "begins<"), 0U);
  records::Warning warning;
  warning.on = true;
  warning.service = records::WarningKind::kEmergencyBraking;
  warning.stamp.true_time = TrueTime{1'000'000'000};
  picture.on(warning);
  EXPECT_EQ(count(picture.svg(), ">emergency braking begins<"), 1U);
  EXPECT_EQ(count(picture.svg(), "begins<"), 1U);
}

}  // namespace
}  // namespace ttf::report::plots
