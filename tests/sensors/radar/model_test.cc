#include "sensors/radar/model.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "sensors/shape.h"
#include "tests/sensors/car_at.h"
#include "tests/support/allocation_counter.h"

namespace ttf::sensors::radar {
namespace {

constexpr ObjectId kFalseReturn{0xffff};

// One point, always detected, and cells that hold it alone.
RadarConfig exact_radar() {
  RadarConfig config;
  config.range_sigma_m = config.azimuth_sigma_rad = config.rate_sigma_mps = config.clutter_per_list = 0.0;
  config.snr_at_100m_db = 80.0;
  config.most_returns = 1;
  config.range_cell_m = config.azimuth_cell_rad = config.rate_cell_mps = 1e-6;
  return config;
}

struct List {
  std::vector<RadarReturn> returns;
  std::vector<ObjectId> truth;
};
List list(const RadarConfig& config, const std::vector<ObjectState>& objects, std::uint32_t sequence = 0,
          const AntennaVelocity& antenna = {}) {
  List l;
  RadarRoom room(objects.size());
  measure_radar(config, objects, antenna, {1, 0, 2, sequence}, room, l.returns, l.truth);
  EXPECT_EQ(l.returns.size(), l.truth.size());
  return l;
}

// The rate at which an outline's point recedes, by differences: the object moves on for a moment.
double rate_by_differences(const ObjectState& car, const AntennaVelocity& antenna, double range, double azimuth) {
  constexpr double kMoment = 1e-5;
  const double turn = car.yaw_rate * kMoment, c = std::cos(turn), s = std::sin(turn);
  const double x = range * std::cos(azimuth) - car.x, y = range * std::sin(azimuth) - car.y;
  const double vx = car.speed * std::cos(car.heading) - antenna.x, vy = car.speed * std::sin(car.heading) - antenna.y;
  return (std::hypot(car.x + vx * kMoment + c * x - s * y, car.y + vy * kMoment + s * x + c * y) - range) / kMoment;
}

TEST(Radar, DetectsAsOftenAsTheClosedFormSays) {
  RadarConfig config = exact_radar();
  config.snr_at_100m_db = 20.0;
  constexpr int kLists = 10'000;
  for (const double x : {100.0, 150.0, 220.0}) {
    // A small object, so that its range is known.
    ObjectState post = car_at(0, x, 10.0);
    post.length = post.width = 0.1;
    const double range = std::hypot(x, 10.0), azimuth = std::atan2(10.0, x);
    const double off = azimuth / (0.5 * config.beam_width_rad);
    const double snr = 100.0 * post.cross_section * std::pow(100.0 / range, 4.0) * std::pow(0.5, 2.0 * off * off);
    const double expected = std::pow(config.false_alarm_probability, 1.0 / (1.0 + snr));
    int detected = 0;
    for (std::uint32_t k = 0; k < kLists; ++k) detected += static_cast<int>(list(config, {post}, k).returns.size());
    EXPECT_NEAR(detected / double{kLists}, expected, 4.0 * std::sqrt(0.25 / kLists) + 0.003) << x;
    EXPECT_NEAR(detection_probability(config, snr_of(config, post.cross_section, range, azimuth)), expected, 1e-6);
  }
}

TEST(Radar, TheWeatherTakesPowerBothWays) {
  RadarConfig rain;
  rain.attenuation_db_per_km = 10.0;
  EXPECT_NEAR(snr_of(rain, 1.0, 100.0, 0.0) / snr_of({}, 1.0, 100.0, 0.0), std::pow(10.0, -0.2), 1e-12);
}

TEST(Radar, PointsLieOnTheOutlineAboutTheMiddleOfItsSilhouette) {
  const RadarConfig config = exact_radar();
  const ObjectState car = car_at(0, 30.0, 4.0, 0.6);
  const auto span = azimuth_span(car);
  ASSERT_TRUE(span);
  constexpr int kLists = 4000;
  double sum = 0.0;
  for (std::uint32_t k = 0; k < kLists; ++k) {
    const List one = list(config, {car}, k);
    ASSERT_EQ(one.returns.size(), 1U);
    EXPECT_NEAR(one.returns[0].range, *RayTarget(car).ray_to(one.returns[0].azimuth), 1e-9);
    sum += one.returns[0].azimuth;
  }
  const double sigma = (span->high - span->low) / std::sqrt(12.0);
  EXPECT_NEAR(sum / kLists, 0.5 * (span->low + span->high), 4.0 * sigma / std::sqrt(kLists));
}

TEST(Radar, TheRangeRateIsThatOfThePointFromTheAntenna) {
  ObjectState car = car_at(0, 20.0, 5.0, 2.0);
  car.speed = 7.0;
  car.yaw_rate = 0.8;
  EgoState ego;
  ego.vx = 12.0;
  ego.yaw_rate = 0.3;
  // At the left corner, looking to the left: the vehicle's turn moves it backwards.
  const AntennaVelocity antenna = antenna_velocity(ego, {.x = 3.5, .y = 0.9, .heading = 0.5 * std::numbers::pi});
  EXPECT_NEAR(antenna.x, 0.3 * 3.5, 1e-12);
  EXPECT_NEAR(antenna.y, -(12.0 - 0.3 * 0.9), 1e-12);
  for (std::uint32_t k = 0; k < 20; ++k) {
    const List one = list(exact_radar(), {car}, k, antenna);
    ASSERT_EQ(one.returns.size(), 1U);
    const RadarReturn& seen = one.returns[0];
    EXPECT_NEAR(seen.range_rate, rate_by_differences(car, antenna, seen.range, seen.azimuth), 1e-3);
  }
}

TEST(Radar, RangeRatesFoldAtTheEdgesOfTheirSpan) {
  RadarConfig config = exact_radar();
  config.rate_span_mps = 40.0;
  ObjectState car = car_at(0, 50.0, 0.0);
  for (const auto& [speed, reported] : {std::pair{19.0, 19.0}, {21.0, -19.0}, {60.0, 20.0}, {-21.0, 19.0}}) {
    car.speed = speed;
    const List one = list(config, {car});
    ASSERT_EQ(one.returns.size(), 1U);
    // Off the axis by up to 0.02 rad.
    EXPECT_NEAR(std::abs(std::remainder(one.returns[0].range_rate - reported, 40.0)), 0.0, 0.02) << speed;
    EXPECT_LE(std::abs(one.returns[0].range_rate), 20.0);
  }
}

TEST(Radar, NoiseHasItsMoments) {
  RadarConfig config = exact_radar();
  config.range_sigma_m = 0.3;
  config.azimuth_sigma_rad = 0.01;
  config.rate_sigma_mps = 0.2;
  ObjectState post = car_at(0, 50.0, 0.0);
  post.length = post.width = 1e-6;
  post.speed = 3.0;
  constexpr int kLists = 4000;
  double mean[3] = {}, squared[3] = {};
  for (std::uint32_t k = 0; k < kLists; ++k) {
    const List one = list(config, {post}, k);
    ASSERT_EQ(one.returns.size(), 1U);
    const double errors[] = {(one.returns[0].range - 50.0) / 0.3, one.returns[0].azimuth / 0.01,
                             (one.returns[0].range_rate - 3.0) / 0.2};
    for (int c = 0; c < 3; ++c) {
      mean[c] += errors[c] / kLists;
      squared[c] += errors[c] * errors[c] / kLists;
    }
  }
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(mean[c], 0.0, 4.0 / std::sqrt(kLists));
    EXPECT_NEAR(squared[c], 1.0, 4.0 * std::sqrt(2.0 / kLists));
  }
}

// Two posts 0.5 m apart, in one cell, and then with range rates of different cells.
TEST(Radar, EchoesOfOneCellAreTheirMeanByPower) {
  RadarConfig config = exact_radar();
  ObjectState left = car_at(0, 50.5, 0.2), right = car_at(1, 51.0, 0.6);
  left.length = left.width = right.length = right.width = 1e-6;
  const List alone = list(config, {left}), other = list(config, {right});
  config.range_cell_m = 2.0;
  config.azimuth_cell_rad = 0.1;
  config.rate_cell_mps = 1.0;
  const List both = list(config, {left, right});
  ASSERT_EQ(both.returns.size(), 1U);
  const double a = std::pow(10.0, 0.1 * alone.returns[0].power_db), b = std::pow(10.0, 0.1 * other.returns[0].power_db);
  EXPECT_NEAR(both.returns[0].range, (a * alone.returns[0].range + b * other.returns[0].range) / (a + b), 1e-9);
  EXPECT_NEAR(both.returns[0].azimuth, (a * alone.returns[0].azimuth + b * other.returns[0].azimuth) / (a + b), 1e-12);
  EXPECT_NEAR(both.returns[0].power_db, 10.0 * std::log10(a + b), 1e-9);
  EXPECT_EQ(both.truth[0], a > b ? left.id : right.id);
  right.speed = 2.5;
  EXPECT_EQ(list(config, {left, right}).returns.size(), 2U);
}

TEST(Radar, NothingHidesUnlessThereIsAShadow) {
  RadarConfig config = exact_radar();
  const std::vector<ObjectState> row{car_at(0, 40.0, 0.0), car_at(1, 15.0, 0.2)};
  EXPECT_EQ(list(config, row).returns.size(), 2U);
  config.shadow = 1e6;
  EXPECT_EQ(list(config, row).truth, std::vector<ObjectId>{ObjectId{1}});
}

TEST(Radar, FieldRangeAndCapacityBoundTheList) {
  RadarConfig config = exact_radar();
  EXPECT_TRUE(list(config, {car_at(0, 20.0, 15.0)}).returns.empty());
  EXPECT_TRUE(list(config, {car_at(0, 260.0, 0.0)}).returns.empty());
  EXPECT_TRUE(list(config, {car_at(0, -20.0, 0.0)}).returns.empty());
  EXPECT_TRUE(list(config, {car_at(0, 0.0, 0.0)}).returns.empty()) << "around the antenna";
  config.max_returns = 1;
  EXPECT_EQ(list(config, {car_at(0, 60.0, 0.0), car_at(1, 30.0, 0.0)}).truth, std::vector<ObjectId>{ObjectId{1}});
  config.clutter_per_list = 20.0;
  EXPECT_EQ(list(config, {car_at(0, 60.0, 0.0), car_at(1, 30.0, 0.0)}).returns.size(), 1U);
}

TEST(Radar, ClutterIsAsOftenAsStated) {
  RadarConfig config;
  config.clutter_per_list = 0.7;
  constexpr int kLists = 4000;
  std::size_t clutter = 0;
  for (std::uint32_t k = 0; k < kLists; ++k) {
    const List one = list(config, {}, k);
    clutter += one.returns.size();
    for (const RadarReturn& seen : one.returns) {
      EXPECT_LE(std::abs(seen.azimuth), config.half_field_rad);
      EXPECT_LE(std::abs(seen.range_rate), 0.5 * config.rate_span_mps);
      EXPECT_GE(seen.power_db, 11.4) << "the threshold";
    }
    EXPECT_TRUE(std::all_of(one.truth.begin(), one.truth.end(), [](ObjectId id) { return id == kFalseReturn; }));
  }
  EXPECT_NEAR(static_cast<double>(clutter) / kLists, 0.7, 4.0 * std::sqrt(0.7 / kLists));
}

TEST(Radar, AnObjectsReturnsDoNotDependOnOthers) {
  RadarConfig config;
  config.clutter_per_list = 0.0;
  for (std::uint32_t k = 0; k < 50; ++k) {
    const List alone = list(config, {car_at(3, 60.0, 2.0)}, k),
               among = list(config, {car_at(0, 20.0, 0.0), car_at(1, 90.0, -4.0), car_at(3, 60.0, 2.0)}, k);
    std::vector<double> theirs, ours;
    for (const RadarReturn& seen : alone.returns) ours.push_back(seen.range);
    for (std::size_t i = 0; i < among.returns.size(); ++i)
      if (among.truth[i] == ObjectId{3}) theirs.push_back(among.returns[i].range);
    EXPECT_EQ(ours, theirs);
  }
}

TEST(Radar, MeasuringAllocatesNothing) {
  const std::vector<ObjectState> objects{car_at(0, 20.0, 0.0), car_at(1, 90.0, -4.0), car_at(2, 60.0, 2.0)};
  RadarConfig config;
  config.shadow = 1.0;
  RadarRoom room(objects.size());
  std::vector<RadarReturn> returns;
  std::vector<ObjectId> truth;
  returns.reserve(64);
  truth.reserve(64);
  const std::int64_t before = support::allocations();
  for (std::uint32_t k = 0; k < 100; ++k) measure_radar(config, objects, {}, {1, 0, 0, k}, room, returns, truth);
  EXPECT_EQ(support::allocations(), before);
}

}  // namespace
}  // namespace ttf::sensors::radar
