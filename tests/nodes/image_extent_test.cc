// What the image says of an object's size, against the truth: within what it states, over the paper's drives and a car that
// crosses.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/sim/drive_fixture.h"

namespace ttf {
namespace {

using testing_support::Drive;

// Errors in units of the stated sigma, from the instant on at which drives are judged.
struct Sizes final : records::Sink {
  using records::Sink::on;
  TrueTime from{};
  std::vector<records::FeatureObject> objects;
  TrueTime used_at{-1};
  struct Errors {
    int count = 0, known = 0, outside_2 = 0, outside_3 = 0;
    double squares = 0.0, worst = 0.0, error_squares = 0.0, sigma_sum = 0.0;
    void add(double error, double sigma) {
      const double e = std::abs(error) / sigma;
      ++known;
      squares += e * e;
      worst = std::max(worst, e);
      outside_2 += e > 2.0;
      outside_3 += e > 3.0;
      error_squares += error * error;
      sigma_sum += sigma;
    }
  } length, width;

  void on(const records::FeatureUsed& used) override {
    objects.assign(used.objects.begin(), used.objects.end());
    used_at = used.stamp.true_time;
  }
  void on(const records::TruthState& truth) override {
    if (truth.at != used_at || truth.at < from) return;
    for (const records::FeatureObject& object : objects) {
      const records::ImageObject& image = object.image;
      if (std::hypot(image.x - truth.x, image.y - truth.y) > 3.0) continue;
      ++length.count;
      ++width.count;
      if (image.sigma_length < 1.0) length.add(image.length - truth.length, image.sigma_length);
      if (image.sigma_width < 0.25) width.add(image.width - truth.width, image.sigma_width);
    }
  }
};

void print(const char* what, const Sizes::Errors& e) {
  std::printf("  %s: n %d known %d ms %.2f worst %.2f out2 %.3f out3 %.3f rms %.3f mean sigma %.3f\n", what, e.count, e.known,
              e.squares / e.known, e.worst, e.outside_2 / double(e.known), e.outside_3 / double(e.known),
              std::sqrt(e.error_squares / e.known), e.sigma_sum / e.known);
}

TEST(ImageExtent, Explore) {
  for (const char* name : {"paper_scenario1", "paper_scenario2", "crossing", "crossing_left", "oncoming"})
    for (const auto strategy : testing_support::kStrategies) {
      Drive drive(std::string("scenarios/") + (name[0] == 'p' ? name : "paper_scenario1") + ".yaml", strategy);
      if (name[0] == 'c') {
        world::ObjectConfig& car = drive.scenario.world.objects[0];
        car.segments.clear();
        car.x = 22.0;
        car.y = name[8] ? 14.0 : -14.0;
        car.heading = name[8] ? -1.2 : 1.5707963;
        car.speed = 8.0;
      }
      if (name[0] == 'o') {
        world::ObjectConfig& car = drive.scenario.world.objects[0];
        car.segments.clear();
        car.x = 50.0;
        car.y = 4.0;
        car.heading = 3.14159265;
        car.speed = 10.0;
      }
      Sizes sizes;
      sizes.from = sim::kFirstCycle + drive.scenario.evaluate_from - Duration::milliseconds(700);
      for (std::uint64_t seed = 1; seed <= 20; ++seed) drive.run(sizes, seed);
      std::printf("%s %d\n", name, static_cast<int>(strategy));
      print("length", sizes.length);
      print("width ", sizes.width);
    }
}

}  // namespace
}  // namespace ttf
