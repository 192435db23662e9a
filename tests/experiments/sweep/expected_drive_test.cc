// The expected errors of a drive, from records by hand: the observations that count, and the part that a size adds.
#include "experiments/sweep/expected_drive.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/file_bytes.h"
#include "schedules/file/loader.h"
#include "sim/drives/drive.h"

namespace ttf::experiments::sweep {
namespace {

constexpr SensorId kLaser{0}, kCamera{1};
constexpr std::string_view kCar = "{name: car, x: 30.0, y: 0.0, speed: 25.0, reference: true}";

constexpr const char* kScenario = R"(name: behind
description: "Behind a car of nominal size"
seed: 1
duration: 3 s
evaluate_from: 1500 ms
clusters:
  buff: ../schedules/paper_unsynchronised.yaml
  adva: ../schedules/paper_unsynchronised.yaml
  tt: ../schedules/paper_synchronised.yaml
world:
  acceleration_noise: 2.0
  speed_memory: 500 ms
  own_speed: 15.0
  size: {draw: nominal}
  objects:
    - {name: car, x: 30.0, y: 0.0, speed: 25.0, reference: true}
reference: {}
tracker:
  process_noise: 0.04
  turn_noise: 0.000001
  initial_turn_rate_sigma: 0.001
  sizes: {length: 4.4, length_sigma: 0.5, width: 1.8, width_sigma: 0.15, correlation: 0}
)";

sim::drives::Scenario scenario_with(const std::vector<std::pair<std::string_view, std::string>>& changes = {}) {
  const std::string file = TTF_SOURCE_DIR "/scenarios/behind.yaml";
  std::string text = kScenario;
  for (const auto& [before, after] : changes) {
    const std::size_t at = text.find(before);
    EXPECT_NE(at, std::string::npos) << before;
    text.replace(at, before.size(), after);
  }
  return sim::drives::parse_scenario(text, file);
}

const schedules::model::Cluster& cluster() {
  static const schedules::model::Cluster paper =
      schedules::file::load_cluster(TTF_SOURCE_DIR "/schedules/paper_synchronised.yaml");
  return paper;
}

TEST(ExpectedDrive, IsDefinedWhereOneFaceShowsOrTheSizeIsKnown) {
  const auto defined = [](const std::vector<std::pair<std::string_view, std::string>>& changes) {
    return ExpectedError::is_defined(scenario_with(changes));
  };
  const std::string known = "sizes: {length: 4.39, length_sigma: 0.02, width: 1.79, width_sigma: 0.02,";
  constexpr std::string_view prior = "sizes: {length: 4.4, length_sigma: 0.5, width: 1.8, width_sigma: 0.15,",
                             nominal = "draw: nominal";
  EXPECT_TRUE(defined({}));
  EXPECT_TRUE(defined({{nominal, "draw: normal"}}));
  EXPECT_TRUE(defined({{nominal, "draw: uniform"}}));
  EXPECT_TRUE(defined({{prior, "sizes: {length: 5.4, length_sigma: 0.5, width: 1.8, width_sigma: 0.15,"}}));
  // From 30 m ahead and 5 m to the left, rear and side are in view.
  const std::string aside = "{name: car, x: 30.0, y: 5.0, speed: 25.0, reference: true}";
  EXPECT_FALSE(defined({{kCar, aside}, {nominal, "draw: normal"}}));
  EXPECT_FALSE(
      defined({{kCar, aside}, {prior, "sizes: {length: 5.4, length_sigma: 0.5, width: 1.8, width_sigma: 0.15,"}}));
  EXPECT_TRUE(defined({{kCar, aside}, {prior, known}})) << "the tracker knows the size";
  EXPECT_FALSE(
      defined({{kCar, aside}, {prior, "sizes: {length: 4.39, length_sigma: 0.5, width: 1.79, width_sigma: 0.15,"}}))
      << "the mean is right by chance";
  // A laser at the corner of the vehicle sees the side, too.
  EXPECT_FALSE(defined({{nominal, "draw: normal"},
                        {"reference: {}", "reference: {}\nsensors: {laser: {kind: laser, mounting: {y: 1.0}}}"}}));
  EXPECT_FALSE(defined({{"process_noise: 0.04", "process_noise: 0.04\n  extent_noise: 0.1"}}));
  EXPECT_FALSE(defined({{"process_noise: 0.04", "process_noise: 0.04\n  motion: ctra"}}));
  EXPECT_FALSE(defined({{kCar, std::string(kCar) + "\n    - {name: other, x: 60.0, y: 0.0, speed: 25.0}"}}));
}

// Records of a drive that is judged from 1500 ms on.
class ByHand {
 public:
  explicit ByHand(const sim::drives::Scenario& scenario)
      : object_(scenario.world.objects.front()), begin_(sim::drives::evaluation_start(scenario)),
        expected(scenario, cluster()) {}

  // A list of this sensor, measured at the instant, with these observations; it is fused 20 ms later.
  struct Observed {
    double x = 0.0, y = 0.0, sxx = 0.01, syy = 0.01;
  };
  double speed = 0.0;  // the object's, relative to the sensors [m/s]
  void list(SensorId sensor, double ms, const std::vector<Observed>& observations) {
    recording::records::TruthState truth;
    truth.at = begin_ + after(ms);
    truth.x = object_.x;
    truth.y = object_.y;
    truth.heading = object_.heading;
    truth.speed = speed;
    truth.length = object_.length;
    truth.width = object_.width;
    expected.on(truth);
    const MeasurementId id{sensor, ++sequence_};
    std::uint16_t index = 0;
    for (const Observed& one : observations) {
      recording::records::ObservationSeen seen;
      seen.stamp = stamp(ms + 10.0);
      seen.id = id;
      seen.measured = instant(ms);
      seen.index = index++;
      seen.x = one.x;
      seen.y = one.y;
      seen.sxx = one.sxx;
      seen.syy = one.syy;
      expected.on(seen);
    }
    recording::records::ListFused fused;
    fused.stamp = stamp(ms + 20.0);
    fused.id = id;
    fused.measured = instant(ms);
    expected.on(fused);
  }
  void use(double ms) {
    const std::vector<recording::records::ImageObject> objects(1);
    recording::records::ImageWritten image;
    image.stamp = stamp(ms - 5.0);
    image.sequence = ++images_;
    image.valid_at = instant(ms);
    image.newest_measurement = instant(ms - 30.0);
    image.objects = objects;
    expected.on(image);
    recording::records::FeatureUsed used;
    used.stamp = stamp(ms);
    used.image_sequence = images_;
    used.image_valid_at = instant(ms);
    expected.on(used);
  }
  GlobalTime instant(double ms) const { return stamp(ms).global; }

 private:
  static Duration after(double ms) { return Duration{static_cast<std::int64_t>(std::llround(ms * 1e6))}; }
  recording::records::Stamp stamp(double ms) const {
    const TrueTime at = begin_ + after(ms);
    return {at, LocalTime{at.ns}, GlobalTime{at.ns}, NodeId{0}};
  }

  sim::world::ObjectConfig object_;
  TrueTime begin_;
  std::uint32_t sequence_ = 0, images_ = 0;

 public:
  ExpectedError expected;
};

constexpr double kRear = 30.0 - 0.5 * 4.39;

// The camera cannot see the object. Its lists have other things, or nothing. Only the laser's lists enter.
TEST(ExpectedDrive, OnlyTheListsOfSensorsThatSeeTheObjectCount) {
  const sim::drives::Scenario scenario = scenario_with();
  ByHand alone(scenario), beside(scenario);
  for (int n = 0; n < 12; ++n) {
    const std::vector<ByHand::Observed> rear{{kRear, 0.0, 0.0004, 0.0016}};
    alone.list(kLaser, 80.0 * n, rear);
    beside.list(kLaser, 80.0 * n, rear);
    beside.list(kCamera, 80.0 * n + 1.0, {});
    beside.list(kCamera, 80.0 * n + 41.0, {{12.0, 8.0}, {kRear - 4.1, 0.0}});
    alone.use(80.0 * n + 30.0);
    beside.use(80.0 * n + 30.0);
  }
  EXPECT_GT(alone.expected.face_mse(), 0.0);
  EXPECT_EQ(beside.expected.face_mse(), alone.expected.face_mse());
  EXPECT_EQ(beside.expected.position_mse(), alone.expected.position_mse());
  // With the camera's eyes it is better.
  ByHand both(scenario);
  for (int n = 0; n < 12; ++n) {
    both.list(kLaser, 80.0 * n, {{kRear, 0.0, 0.0004, 0.0016}});
    both.list(kCamera, 80.0 * n + 1.0, {{kRear, 0.0, 0.01, 0.01}});
    both.use(80.0 * n + 30.0);
  }
  EXPECT_LT(both.expected.face_mse(), alone.expected.face_mse());
}

// It follows from covariances and instants alone.
TEST(ExpectedDrive, TheFacesErrorIsThatOfTheRecursion) {
  const sim::drives::Scenario scenario = scenario_with({{"  speed_memory: 500 ms\n", ""}});
  ByHand hand(scenario);
  PointMotion motion = PointMotion::known(0.04, scenario.tracker.initial_velocity_sigma);
  motion.actual = Eigen::Vector2d(0.04, 0.0).asDiagonal();
  motion.actual_velocity = Eigen::Vector2d(100.0, 0.0).asDiagonal();
  ErrorRecursion recursion(motion);
  double sum = 0.0;
  for (int n = 0; n < 5; ++n) {
    hand.list(kLaser, 80.0 * n, {{kRear, 0.1, 0.0004, 0.0016}});
    recursion.fuse({hand.instant(80.0 * n), Eigen::Vector2d(0.0004, 0.0016).asDiagonal()});
    hand.use(80.0 * n + 30.0);
    sum += recursion.at(hand.instant(80.0 * n + 30.0)).topLeftCorner<2, 2>().trace() / 5.0;
  }
  EXPECT_NEAR(hand.expected.face_mse(), sum, 1e-9 * sum);
}

// The nominal length is 0.01 m less than the prior's. The heading swings half of the assumed length. A laser measures it, or the
// velocity across it.
TEST(ExpectedDrive, TheHeadingSwingsTheCentre) {
  const sim::drives::Scenario scenario = scenario_with({{"  speed_memory: 500 ms\n", ""}});
  const double half = 0.5 * 4.4, length = 0.25 * 0.01 * 0.01;
  ByHand standing(scenario), moving(scenario);
  standing.list(kLaser, 0.0, {{kRear, 0.0, 0.0004, 0.0016}});
  standing.use(0.0);
  EXPECT_NEAR(standing.expected.position_mse() - standing.expected.face_mse(),
              length + half * half * 12.0 * 0.0004 / (1.8 * 1.8), 1e-9);

  moving.speed = 10.0;
  PointMotion motion = PointMotion::known(0.04, scenario.tracker.initial_velocity_sigma);
  motion.actual = Eigen::Vector2d(0.04, 0.0).asDiagonal();
  motion.actual_velocity = Eigen::Vector2d(100.0, 0.0).asDiagonal();
  ErrorRecursion recursion(motion);
  for (int n = 0; n < 20; ++n) {
    moving.list(kCamera, 40.0 * n, {{kRear, 0.0, 0.01, 0.01}});
    recursion.fuse({moving.instant(40.0 * n), 0.01 * Eigen::Matrix2d::Identity()});
  }
  moving.use(800.0);
  const Eigen::Matrix4d error = recursion.at(moving.instant(800.0));
  const double swung = 2.0 * half / 10.0 * error(1, 3) + half * half / 100.0 * error(3, 3);
  EXPECT_NEAR(moving.expected.position_mse() - moving.expected.face_mse(), length + swung, 1e-9);
}

// The rear of a lorry is 6 m from its centre. It counts. An observation 2.5 m beside the lorry does not.
TEST(ExpectedDrive, ObservationsArePairedByTheOutline) {
  const std::string lorry = "{name: car, x: 30.0, y: 0.0, speed: 25.0, length: 12.0, width: 2.5, reference: true}";
  ByHand clear(scenario_with({{kCar, lorry}})), crowded(scenario_with({{kCar, lorry}}));
  for (int n = 0; n < 5; ++n) {
    clear.list(kLaser, 80.0 * n, {{24.0, 0.0, 0.0004, 0.0016}});
    crowded.list(kLaser, 80.0 * n, {{30.0, 3.75, 1.0, 1.0}, {24.0, 0.0, 0.0004, 0.0016}});
    clear.use(80.0 * n + 30.0);
    crowded.use(80.0 * n + 30.0);
  }
  EXPECT_GT(clear.expected.face_mse(), 0.0);
  EXPECT_EQ(crowded.expected.face_mse(), clear.expected.face_mse());
}

// A length shifts the centre by half of its error. Seen widths correct it. A car of known size has the heading's part alone.
TEST(ExpectedDrive, ADrawnLengthShiftsTheCentre) {
  const auto position = [](const std::string& draw, const std::string& correlation) {
    ByHand hand(scenario_with({{"draw: nominal", "draw: " + draw},
                               {kCar, "{name: car, x: 30.0, y: 0.0, speed: 25.0, length: 4.65, width: 1.76}"},
                               {"length_sigma: 0.5, width: 1.8, width_sigma: 0.15, correlation: 0}",
                                "length_sigma: 0.37, width: 1.76, width_sigma: 0.1, correlation: " + correlation + "}"},
                               {"{length: 4.4", "{length: 4.65"}}));
    hand.speed = 10.0;
    for (int n = 0; n < 30; ++n) hand.list(kCamera, 40.0 * n, {{kRear, 0.0, 0.01, 0.01}});
    hand.use(40.0 * 29 + 30.0);
    return hand.expected.position_mse();
  };
  const double known = position("nominal", "0");
  const auto added = [&](const std::string& draw, const std::string& correlation) {
    return position(draw, correlation) - known;
  };
  const double quarter = 0.25 * 0.37 * 0.37;
  EXPECT_NEAR(added("normal", "0"), quarter, 1e-3 * quarter);
  EXPECT_NEAR(added("uniform", "0"), 0.25 * (1.22 * 1.22 / 12.0 + 0.25 * 0.25), 1e-9) << "the prior is off by 0.25 m";
  // Thirty widths of 0.05 m give 96 % or more of an exact one.
  const double reported = added("normal", "0.82");
  EXPECT_GT(reported, (1.0 - 0.82 * 0.82) * quarter);
  EXPECT_LT(reported, (1.0 - 0.96 * 0.82 * 0.82) * quarter);
}

// A returning fusion node has forgotten widths, too.
TEST(ExpectedDrive, ARestartForgets) {
  const sim::drives::Scenario scenario = scenario_with({{"draw: nominal", "draw: normal"}});
  ByHand once(scenario), again(scenario);
  for (int n = 0; n < 10; ++n) again.list(kCamera, 800.0 + 40.0 * n, {{kRear, 0.0, 0.01, 0.01}});
  for (ByHand* hand : {&once, &again}) {
    hand->list(kLaser, 0.0, {{kRear, 0.0, 0.0004, 0.0016}});
    hand->use(30.0);
  }
  EXPECT_EQ(again.expected.face_mse(), once.expected.face_mse());
  EXPECT_EQ(again.expected.position_mse(), once.expected.position_mse());
}

}  // namespace
}  // namespace ttf::experiments::sweep
