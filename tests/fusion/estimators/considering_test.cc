// Sensors with the same error throughout a drive. A tracker that ignores the error is overconfident; one that
// considers it is consistent. Covers the whole tracker: birth, gates, association, late lists.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "fusion/estimators/considering.h"
#include "fusion/metrics/consistency.h"
#include "fusion/tracks/timeline.h"
#include "tests/fusion/dense.h"
#include "tests/fusion/drives.h"
#include "tests/support/allocation_counter.h"

namespace ttf::fusion::estimators {
namespace {

constexpr int kLaser = 0, kRadar = 1;
constexpr double kNoise = 0.5;  // of the motion [m^2/s^3]

// A slightly rotated laser at the front and a radar at the side: seven biases.
std::vector<sensors::KnownSensor> laser_and_radar_biases() {
  std::vector<sensors::KnownSensor> sensors(2);
  sensors[kLaser].mounting = {.position = {3.5, 0.5}, .yaw = 0.2};
  sensors[kLaser].errors.sigma << 0.3, 0.015, 0.0, 0.03;
  sensors[kRadar].mounting = {.position = {1.0, -0.9}, .yaw = -0.4};
  sensors[kRadar].errors.sigma << 0.4, 0.02, 0.15, 0.02;
  return sensors;
}

config::TrackerConfig config_with(config::SystematicErrorsAre answer,
                                  std::vector<sensors::KnownSensor> sensors = laser_and_radar_biases(),
                                  config::MotionModel motion = config::MotionModel::kConstantVelocity) {
  config::TrackerConfig config = config_of(motion, kNoise);
  config.systematic = answer;
  config.sensors = std::move(sensors);
  config.initial_velocity_sigma = 4.0;
  config.gate_probability = 0.99999;
  return config;
}

// This sensor's observation of x with the errors b, in its own axes; its stamp is off by b(3).
sensors::Observation seen(const State& x, int sensor, const sensors::KnownSensor& known, const linear::Vector<4>& b,
                          RandomStream& stream) {
  motion::Kinematics k{.position = x.head<2>() + b(3) * x.segment<2>(2), .velocity = x.segment<2>(2)};
  const double c = std::cos(known.mounting.yaw), s = std::sin(known.mounting.yaw);
  linear::Matrix<2> back;
  back << c, s, -s, c;
  k.position = (back * (k.position - known.mounting.position)).eval();
  k.velocity = (back * k.velocity).eval();
  linear::Vector<3> z = sensors::RangeBearingRate{}.expected(k) + b.head<3>();
  if (sensor == kLaser)
    return position(z(0) * std::cos(z(1)) + 0.2 * stream.normal(), z(0) * std::sin(z(1)) + 0.2 * stream.normal(), 0.2);
  sensors::Observation o = radar(0, 0, 0, 0.25, 0.006, 0.1);
  for (int i = 0; i < 3; ++i) o.z(i) = z(i) + std::sqrt(o.r(i, i)) * stream.normal();
  return o;
}

struct BiasedDrive {
  std::vector<OwnedList> lists;  // for one object, laser and radar in turn, 40 ms apart; `first` is the first
  std::vector<State> truth;      // at the stamps
};
BiasedDrive drawn_biased(std::uint64_t seed, int run, int lists,
                         config::MotionModel motion = config::MotionModel::kConstantVelocity, int first = kLaser) {
  const std::vector<sensors::KnownSensor> sensors = laser_and_radar_biases();
  RandomStream stream({.seed = seed, .replication = static_cast<std::uint32_t>(run)});
  linear::Vector<4> bias[2];
  for (int s = 0; s < 2; ++s)
    for (int i = 0; i < 4; ++i) bias[s](i) = sensors[static_cast<std::size_t>(s)].errors.sigma(i) * stream.normal();
  BiasedDrive drive;
  State x = State::Zero();
  x.head<4>() << 45.0, 15.0, 4.0 * stream.normal(), 4.0 * stream.normal();
  if (motion == config::MotionModel::kConstantAcceleration) x.tail<2>() << 2.0 * stream.normal(), 2.0 * stream.normal();
  for (int k = 0; k < lists; ++k) {
    if (k > 0) x = draw(transition(motion, 0.04) * x, driving_noise(motion, kNoise, 0.04), stream);
    const int sensor = (k + first) % 2;
    const sensors::KnownSensor& known = sensors[static_cast<std::size_t>(sensor)];
    sensors::Observation o = seen(x, sensor, known, bias[sensor], stream);
    place(o, static_cast<SensorId>(sensor), known);
    drive.lists.push_back(
        list_of(static_cast<std::uint8_t>(sensor), static_cast<std::uint32_t>(k / 2), at_ms(40 * k), {o}));
    drive.truth.push_back(x);
  }
  return drive;
}

// Independent drives through a whole tracker, each judged once, after its last list.
struct Judged {
  metrics::Consistency nees;
  double position_squared = 0.0, velocity_squared = 0.0;  // means
};
Judged judged(const config::TrackerConfig& config, std::uint64_t seed, int runs, int lists, int first) {
  Judged out;
  tracks::Tracker tracker(config, 2);
  const int n = config.motion == config::MotionModel::kConstantVelocity ? 4 : 6;
  for (int run = 0; run < runs; ++run) {
    const BiasedDrive drive = drawn_biased(seed, run, lists, config.motion, first);
    tracks::TrackSet set(tracker.max_tracks());
    for (const OwnedList& one : drive.lists) tracker.step(set, one.view());
    const Cartesian end = tracker.estimator().cartesian(set.tracks.front().estimate);
    const State error = drive.truth.back() - end.x;
    const Eigen::VectorXd part = error.head(n);
    out.nees.add(norm_squared(part, end.p.topLeftCorner(n, n)), n);
    out.position_squared += error.head<2>().squaredNorm() / runs;
    out.velocity_squared += error.segment<2>(2).squaredNorm() / runs;
  }
  return out;
}

constexpr config::SystematicErrorsAre kIgnored = config::SystematicErrorsAre::kIgnored,
                                      kConsidered = config::SystematicErrorsAre::kConsidered;

void expect_only_the_considering_one_consistent(config::MotionModel motion, int lists, int first = kLaser) {
  constexpr int kRuns = 400;
  const std::vector<sensors::KnownSensor> sensors = laser_and_radar_biases();
  for (const std::uint64_t seed : {1u, 2u}) {
    const Judged considered = judged(config_with(kConsidered, sensors, motion), seed, kRuns, lists, first);
    EXPECT_TRUE(considered.nees.consistent()) << considered.nees.mean() << " of " << considered.nees.expected();
    const Judged ignored = judged(config_with(kIgnored, sensors, motion), seed, kRuns, lists, first);
    EXPECT_GT(ignored.nees.mean(), 2.0 * ignored.nees.band().high);
    if (lists >= 10) {
      EXPECT_LT(considered.position_squared, 0.9 * ignored.position_squared) << "weighs better, too";
      EXPECT_LT(considered.velocity_squared, ignored.velocity_squared);
    }
  }
}

TEST(Considering, IsConsistentFromBirthOnWhereIgnoringIsNot) {
  for (const int lists : {1, 2, 3, 10, 60})
    expect_only_the_considering_one_consistent(config::MotionModel::kConstantVelocity, lists);
  for (const int lists : {10, 60})
    expect_only_the_considering_one_consistent(config::MotionModel::kConstantVelocity, lists, kRadar);
}
TEST(Considering, IsConsistentWithAccelerations) {
  for (const int lists : {1, 2, 60})
    expect_only_the_considering_one_consistent(config::MotionModel::kConstantAcceleration, lists);
}

// A sensor's first sight of an unknown object is an update of a state that may be anywhere.
TEST(Considering, ABirthIsAnUpdateOfAlmostNothing) {
  using M = motion::ConstantVelocity;
  std::vector<sensors::KnownSensor> sensors = laser_and_radar_biases();
  for (const sensors::ErrorAxes axes : {sensors::ErrorAxes::kPolar, sensors::ErrorAxes::kCartesian})
    for (const int sensor : {kLaser, kRadar}) {
      for (sensors::KnownSensor& one : sensors) {
        one.errors.axes = axes;
        if (axes == sensors::ErrorAxes::kCartesian) one.errors.sigma << 0.3, 0.2, 0.0, 0.0;
        // The stamp's error has second-order effects here, and a radar does not measure the cross velocity.
        one.errors.sigma(3) = 0.0;
      }
      const config::TrackerConfig config = config_with(kConsidered, sensors);
      sensors::Observation z = sensor == kLaser ? position(30.0, 8.0, 0.2) : radar(30.0, 0.3, 0.0, 0.25, 0.006, 0.1);
      place(z, static_cast<SensorId>(sensor), sensors[static_cast<std::size_t>(sensor)]);
      const auto born = std::get<WithBiases<4>>(make_estimator(config)->initial(z));

      const estimators::AllBiases biases(sensors);
      const filters::Consider<sensors::kMostBiases> filter{.bias = biases.covariance()};
      WithBiases<4> vague;
      vague.state.x = born.state.x;
      vague.state.p.diagonal() << 1e7, 1e7, 16.0, 16.0;
      if (sensor == kLaser)
        filter.update(M{}, sensors::AmongBiases<sensors::Position>{{}, biases.of(z.sensor), z.from},
                      sensors::Measurement<2>{z.z.head<2>(), z.r.topLeftCorner<2, 2>()}, vague);
      else
        filter.update(
            M{},
            sensors::AmongBiases<sensors::Mounted<sensors::RangeBearingRate>>{
                sensors::Mounted<sensors::RangeBearingRate>(sensors[kRadar].mounting), biases.of(z.sensor), z.from},
            sensors::Measurement<3>{z.z, z.r}, vague);
      EXPECT_LT((vague.state.x - born.state.x).norm(), 1e-6);
      const linear::Matrix<2> p = vague.state.p.topLeftCorner<2, 2>() - born.state.p.topLeftCorner<2, 2>();
      EXPECT_LT(p.norm(), 1e-5) << "sensor " << sensor;
      const linear::Matrix<2, sensors::kMostBiases> cross = vague.cross.topRows<2>() - born.cross.topRows<2>();
      EXPECT_LT(cross.norm(), 1e-5) << "sensor " << sensor;
      EXPECT_GT(born.cross.topRows<2>().norm(), 1e-3);
    }
}

TEST(Considering, NothingToConsiderIsIgnoring) {
  std::vector<sensors::KnownSensor> sensors = laser_and_radar_biases();
  for (sensors::KnownSensor& sensor : sensors) sensor.errors.sigma.setZero();
  for (const config::MotionModel motion :
       {config::MotionModel::kConstantVelocity, config::MotionModel::kConstantAcceleration}) {
    tracks::Tracker ignoring(config_with(kIgnored, sensors, motion), 2);
    tracks::Tracker considering(config_with(kConsidered, sensors, motion), 2);
    tracks::TrackSet a(ignoring.max_tracks()), b(considering.max_tracks());
    for (const OwnedList& one : drawn_biased(3, 0, 100, motion).lists) {
      ignoring.step(a, one.view());
      considering.step(b, one.view());
      ASSERT_EQ(a.tracks.size(), b.tracks.size());
      for (std::size_t t = 0; t < a.tracks.size(); ++t) {
        const Cartesian one_way = ignoring.estimator().cartesian(a.tracks[t].estimate);
        const Cartesian other = considering.estimator().cartesian(b.tracks[t].estimate);
        EXPECT_LT((one_way.x - other.x).norm(), 1e-12 * one_way.x.norm());
        EXPECT_LT((one_way.p - other.p).norm(), 1e-12 * one_way.p.norm());
      }
    }
  }
}

// A second sensor, rotated by its bias, sees 60 m away. Ignoring the bias puts it outside the gate.
TEST(Considering, GatesAreAsWideAsTheBiases) {
  std::vector<sensors::KnownSensor> sensors(2);
  sensors[1].errors.sigma << 0.0, 0.05, 0.0, 0.0;
  sensors::Observation first = position(60.0, 0.0, 0.2),
                       turned = position(60.0 * std::cos(0.1), 60.0 * std::sin(0.1), 0.2);
  place(first, SensorId{0}, sensors[0]);
  place(turned, SensorId{1}, sensors[1]);
  for (const config::SystematicErrorsAre answer : {kIgnored, kConsidered}) {
    tracks::Tracker tracker(config_with(answer, sensors), 2);
    tracks::TrackSet set(tracker.max_tracks());
    for (std::uint32_t k = 0; k < 5; ++k) tracker.step(set, list_of(0, k, at_ms(40 * k), {first}).view());
    tracker.step(set, list_of(1, 0, at_ms(180), {turned}).view());
    EXPECT_EQ(set.tracks.size(), answer == kIgnored ? 2u : 1u);
    EXPECT_EQ(set.tracks[0].misses, answer == kIgnored ? 1 : 0);
  }
}

// The search by x finds every track that a gate would accept: the same as computing every distance.
TEST(Considering, TheExpectedPositionIsThatOfTheGate) {
  const config::TrackerConfig config = config_with(kConsidered);
  const auto estimator = make_estimator(config);
  const BiasedDrive drive = drawn_biased(4, 0, 9);
  Estimate estimate = estimator->initial(drive.lists[0].observations[0]);
  for (std::size_t k = 1; k < drive.lists.size(); ++k) {
    estimator->predict(estimate, 0.04);
    const sensors::Observation& z = drive.lists[k].observations[0];
    if (z.kind == sensors::ObservationKind::kPosition) {
      const linear::Gaussian<2> expected = estimator->seen_position(estimate, z.sensor, z.from);
      const linear::Matrix<2> s = expected.p + z.r.topLeftCorner<2, 2>();
      const double squared = metrics::normalised_squared<2>(z.z.head<2>() - expected.x, s);
      EXPECT_NEAR(estimator->distance_squared(estimate, z).value() / squared, 1.0, 1e-9);
      EXPECT_GT((expected.p - estimator->position(estimate).p).norm(), 1e-3) << "biases count";
    }
    estimator->update(estimate, z);
  }
}

// Two sensors see 25 objects. Late lists give the same bits as arrival in order, without allocation.
config::TrackerConfig config_of_crowd() {
  std::vector<sensors::KnownSensor> sensors(2);
  sensors[0].errors.sigma << 0.2, 0.01, 0.0, 0.01;
  sensors[1].errors.axes = sensors::ErrorAxes::kCartesian;
  sensors[1].errors.sigma << 0.3, 0.3, 0.0, 0.0;
  config::TrackerConfig config = config_with(kConsidered, sensors);
  config.gate_probability = config::TrackerConfig{}.gate_probability;
  config.process_noise = 3.0;
  return config;
}
std::vector<Arrival> crowd_arrivals(std::uint64_t seed) {
  std::vector<Arrival> arrivals = drawn_drive(seed, 40);
  for (Arrival& arrival : arrivals)
    for (sensors::Observation& z : arrival.list.observations) z.sensor = arrival.list.id.sensor;
  return arrivals;
}
TEST(Considering, LateListsGiveTheBitsOfArrivalInOrder) {
  const config::TrackerConfig config = config_of_crowd();
  std::vector<Arrival> arrivals = crowd_arrivals(7);
  std::sort(arrivals.begin(), arrivals.end(), [](const Arrival& a, const Arrival& b) {
    return tracks::before(a.list.id, a.list.measured, b.list.id, b.list.measured);
  });
  tracks::Timeline in_order(config, 64);
  for (const Arrival& arrival : arrivals) in_order.insert(arrival.list.view());
  ASSERT_GE(in_order.current().tracks.size(), 25u);
  EXPECT_GT(std::get<WithBiases<4>>(in_order.current().tracks[0].estimate).cross.norm(), 1e-3);
  RandomStream stream({.seed = 8});
  for (int draw = 0; draw < 10; ++draw) {
    std::vector<Arrival> shuffled = arrivals;
    for (std::size_t i = shuffled.size(); i > 1; --i)  // up to 20 places
      std::swap(shuffled[i - 1], shuffled[i - 1 -
                                          static_cast<std::size_t>(stream.integer(
                                              0, static_cast<std::int64_t>(std::min<std::size_t>(i - 1, 20))))]);
    tracks::Timeline timeline(config, 64);
    int late = 0;
    for (const Arrival& arrival : shuffled)
      late += timeline.insert(arrival.list.view()) == tracks::Timeline::Insertion::kLate;
    EXPECT_GT(late, 20);
    EXPECT_TRUE(same_bits(timeline.current(), in_order.current())) << "draw " << draw;
  }
}
TEST(Considering, AllocatesNothingAfterConstruction) {
  std::vector<Arrival> arrivals = crowd_arrivals(9);
  sort_by_arrival(arrivals);
  const auto strategy = make_strategy(strategies::StrategyKind::kAdva, config_of_crowd(), laser_and_camera());
  std::vector<tracks::TrackView> image;
  image.reserve(64);
  const std::int64_t before = support::allocations();
  for (const Arrival& arrival : arrivals) {
    strategy->accept(arrival.list.view());
    strategy->fuse(at_ms(arrival.ms));
    strategy->image(at_ms(arrival.ms + 40), image);
  }
  EXPECT_EQ(support::allocations() - before, 0);
  EXPECT_EQ(image.size(), 25u);
}

// A laser and a radar at the back, looking backwards, see the same as from the origin. Tracks and considered
// covariances are equal.
TEST(Mounting, BackwardsTheSameTracks) {
  std::vector<sensors::KnownSensor> ahead(2), behind(2);
  for (std::vector<sensors::KnownSensor>* sensors : {&ahead, &behind})
    for (sensors::KnownSensor& sensor : *sensors) sensor.errors.sigma << 0.2, 0.01, 0.0, 0.01;
  for (sensors::KnownSensor& sensor : behind) sensor.mounting = {.position = {-1.5, 0.4}, .yaw = std::numbers::pi};
  for (sensors::KnownSensor& sensor : ahead)
    sensor.mounting.position = {-1.5, 0.4};  // polar errors are seen from there
  for (const config::SystematicErrorsAre answer : {kIgnored, kConsidered}) {
    tracks::Tracker one(config_with(answer, ahead), 2), other(config_with(answer, behind), 2);
    tracks::TrackSet a(one.max_tracks()), b(other.max_tracks());
    RandomStream stream({.seed = 5});
    State x = State::Zero();
    x.head<4>() << -40.0, 6.0, 3.0, 1.0;
    for (std::uint32_t k = 0; k < 40; ++k) {
      x.head<2>() += 0.04 * x.segment<2>(2);
      const int sensor = static_cast<int>(k % 2);
      const auto s = static_cast<std::size_t>(sensor);
      const auto id = static_cast<SensorId>(sensor);
      sensors::Observation z = seen(x, sensor, ahead[s], linear::Vector<4>::Zero(), stream);
      sensors::Observation turned = z;
      if (sensor == kLaser)
        turned.z.head<2>() *= -1.0;
      else
        turned.z(1) = std::remainder(turned.z(1) - std::numbers::pi, 2.0 * std::numbers::pi);
      z.has_heading = turned.has_heading = true;
      z.sigma_heading = turned.sigma_heading = 0.1;
      z.heading = 0.3;
      turned.heading = 0.3 - std::numbers::pi;
      place(z, id, ahead[s]);
      place(turned, id, behind[s]);
      one.step(a, list_of(static_cast<std::uint8_t>(sensor), k, at_ms(40 * k), {z}).view());
      other.step(b, list_of(static_cast<std::uint8_t>(sensor), k, at_ms(40 * k), {turned}).view());
      ASSERT_EQ(a.tracks.size(), b.tracks.size());
      const Cartesian p = one.estimator().cartesian(a.tracks[0].estimate);
      const Cartesian q = other.estimator().cartesian(b.tracks[0].estimate);
      EXPECT_LT((p.x - q.x).norm(), 1e-9);
      EXPECT_LT((p.p - q.p).norm(), 1e-9);
      EXPECT_NEAR(a.tracks[0].heading.value, b.tracks[0].heading.value, 1e-9);
    }
    EXPECT_EQ(a.tracks.size(), 1u);
    EXPECT_LT((one.estimator().cartesian(a.tracks[0].estimate).x.head<2>() - x.head<2>()).norm(), 0.5);
  }
}

}  // namespace
}  // namespace ttf::fusion::estimators
