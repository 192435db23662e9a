// A drive seen from above: gathered from records, at an instant, packed for the page, and as a picture.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include "report/scene/packed.h"
#include "report/scene/scene.h"
#include "report/scene/still.h"
#include "report/scene/view.h"
#include "tests/report/layout.h"
#include "tests/report/synthetic_drive.h"

namespace ttf::report::scene {
namespace {

using testing::DoubleNear;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Pointwise;
using testing::SizeIs;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::vector<ViewedSensor> laser_and_camera() {
  return {{"laser", "#d55e00", recording::scene::Pose{}, recording::scene::ViewedField{1.0, 0.0, 100.0}},
          {"camera", "#0072b2", std::nullopt, std::nullopt}};
}
TrueTime ms(std::int64_t t) { return {t * 1'000'000}; }

// Every instant is the same on all clocks.
struct Records {
  SceneSink sink;
  explicit Records(SceneLimits limits = {}) : sink(laser_and_camera(), limits) {}

  static recording::records::Stamp stamp(std::int64_t t) { return {ms(t), {ms(t).ns}, {ms(t).ns}, NodeId{5}}; }
  void truth(std::int64_t t, double x, int object = 3) {
    recording::records::TruthState state;
    state.at = ms(t);
    state.object = static_cast<ObjectId>(object);
    state.x = x;
    state.length = 4.4;
    state.width = 1.8;
    sink.on(state);
  }
  static recording::records::ImageObject track(int id, double x, double speed) {
    recording::records::ImageObject object;
    object.track = static_cast<TrackId>(id);
    object.x = x;
    object.speed = speed;
    object.length = 4.0;
    object.width = 2.0;
    object.sigma_x = 0.5;
    object.sigma_y = 0.25;
    object.status = recording::records::ImageStatus::kConfirmed;
    return object;
  }
  void image(std::int64_t t, const std::vector<recording::records::ImageObject>& objects) {
    recording::records::ImageWritten image;
    image.stamp = stamp(t);
    image.valid_at = {ms(t).ns};
    image.objects = objects;
    sink.on(image);
  }
  void odometry(std::int64_t t, double speed, double yaw_rate, SensorId sensor = SensorId{1}) {
    recording::records::OdometryTaken taken;
    taken.stamp = stamp(t);
    taken.id.sensor = sensor;
    taken.speed = speed;
    taken.yaw_rate = yaw_rate;
    sink.on(taken);
  }
  void use(std::int64_t t, int track, bool warning) {
    recording::records::FeatureObject object{Records::track(track, 0, 0), 1.25, kInfinity, warning};
    recording::records::FeatureUsed use;
    use.stamp = stamp(t);
    use.objects = {&object, 1};
    sink.on(use);
  }
  void observation(std::int64_t t, int sensor, std::uint32_t sequence, double x) {
    recording::records::ObservationSeen seen;
    seen.stamp = stamp(t);
    seen.id = {static_cast<SensorId>(sensor), sequence};
    seen.measured = {ms(t).ns};
    seen.x = x;
    sink.on(seen);
  }
};

template <class Number> std::vector<Number> decoded(const std::string& text) {
  static const std::string kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  unsigned held = 0, bits = 0;
  for (const char c : text) {
    if (c == '=') break;
    held = held << 6 | static_cast<unsigned>(kDigits.find(c));
    bits += 6;
    if (bits >= 8) bytes += static_cast<char>(held >> (bits -= 8) & 0xffu);
  }
  std::vector<Number> numbers(bytes.size() / sizeof(Number));
  std::memcpy(numbers.data(), bytes.data(), numbers.size() * sizeof(Number));
  return numbers;
}

TEST(Scene, AnInstantHasTheNewestOfEverything) {
  Records log;
  log.truth(1000, 30.0);
  log.image(1000, {Records::track(7, 29.0, 10.0), Records::track(8, 60.0, 0.0)});
  log.observation(1010, 0, 1, 28.0);
  log.observation(1010, 9, 1, 28.0);  // the log does not name this sensor
  log.use(1020, 7, true);
  log.truth(1100, 32.0);
  log.truth(1100, 1e300, 4);  // a damaged log's
  log.image(1200, {Records::track(7, 31.5, 10.0)});
  log.use(1220, 7, false);
  const Scene scene = log.sink.finished();
  EXPECT_EQ(scene.first, ms(1000));
  EXPECT_EQ(scene.last, ms(1220));
  EXPECT_THAT(scene.thinned_words(), IsEmpty());

  const View now = view_at(scene, ms(1050));
  ASSERT_THAT(now.truth, SizeIs(1));
  EXPECT_FLOAT_EQ(now.truth[0].x, 31.0f);  // half-way between two instants
  ASSERT_THAT(now.tracks, SizeIs(2));
  EXPECT_FLOAT_EQ(now.tracks[0].x, 29.5f);  // 50 ms at 10 m/s
  ASSERT_THAT(now.lists, SizeIs(2));
  EXPECT_THAT(now.lists[0], SizeIs(1));
  EXPECT_THAT(now.lists[1], IsEmpty());
  ASSERT_THAT(now.warnings, SizeIs(1));
  EXPECT_EQ(words_of(now.warnings[0]), "gap of 1.2 s");

  const View later = view_at(scene, ms(1320));
  EXPECT_THAT(later.tracks, SizeIs(1));
  EXPECT_THAT(later.trails[0], SizeIs(2));  // where both images had it, the oldest first
  EXPECT_EQ(later.trails[0][0].x, 29.0);
  EXPECT_THAT(later.lists[0], IsEmpty());  // a list is old after 300 ms
  EXPECT_THAT(later.warnings, IsEmpty());

  EXPECT_THAT(view_at(scene, ms(999)).tracks, IsEmpty());
  EXPECT_THAT(view_at(scene, ms(2201)).tracks, IsEmpty());  // an image is old after a second
}

// A vehicle drives on a circle: 10 m/s, 0.5 rad/s. An object stands 30 m ahead.
TEST(Scene, ADrivingVehicleMovesTheTracksOnByItsOwnMotion) {
  Records log;
  log.odometry(990, 10.0, 0.5);
  log.image(1000, {Records::track(7, 30.0, 0.0)});
  log.odometry(1040, 11.0, 0.0);  // the next image has it
  const View view = view_at(log.sink.finished(), ms(1200));
  ASSERT_THAT(view.tracks, SizeIs(1));
  // The vehicle has come to (20 sin 0.1, 20 (1 - cos 0.1)), and its axes have turned by 0.1 rad.
  const double x = 30.0 - 20.0 * std::sin(0.1), y = -20.0 * (1.0 - std::cos(0.1));
  EXPECT_NEAR(view.tracks[0].x, std::cos(0.1) * x + std::sin(0.1) * y, 2e-3);
  EXPECT_NEAR(view.tracks[0].y, std::cos(0.1) * y - std::sin(0.1) * x, 2e-3);
  EXPECT_NEAR(view.tracks[0].heading, -0.1, 1e-6);
  EXPECT_EQ(view.own.yaw_rate, 0.5);
}

TEST(Scene, ArrowsOfADrivingVehicleAreRelativeAndItsOdometrySeesNoObjects) {
  Records log;
  log.odometry(990, 10.0, 0.0);
  log.image(1000, {Records::track(7, 30.0, 0.0), Records::track(8, 60.0, 10.0)});
  const Scene scene = log.sink.finished();
  const std::string svg = scene_svg(scene, ms(1000), synthetic_names(), "drive");
  EXPECT_EQ(count(svg, "class=\"velocity\""), 1u);  // the standing one comes nearer, the other stays ahead
  EXPECT_THAT(svg, HasSubstr("as the vehicle sees it"));
  EXPECT_THAT(svg, HasSubstr("laser: observations"));
  EXPECT_THAT(svg, testing::Not(HasSubstr("camera: observations")));  // this odometry's name
  const nlohmann::ordered_json json = packed(scene, synthetic_names(), "tt", 0);
  EXPECT_FALSE(json["sensors"][0].contains("odometry"));
  EXPECT_TRUE(json["sensors"][1]["odometry"]);
  EXPECT_THAT(decoded<std::int16_t>(json["own"]["speed"]), ElementsAre(1000));
  EXPECT_THAT(decoded<float>(json["own"]["yaw_rate"]), ElementsAre(0.0f));
}

TEST(Scene, AFullSceneKeepsFewerInstantsAndEveryWarningsEnds) {
  SceneLimits limits;
  limits.bytes = 4000;
  Records log(limits);
  for (int t = 0; t < 2000; t += 10) {
    log.image(t, {Records::track(1, 20.0, 0.0)});
    log.use(t + 5, 1, t >= 1000 && t < 1010);
  }
  const Scene scene = log.sink.finished();
  EXPECT_EQ(scene.spacing, Duration::milliseconds(20));
  EXPECT_FALSE(scene.cut);
  EXPECT_THAT(scene.images, SizeIs(100));
  ASSERT_THAT(scene.warnings, SizeIs(2));  // though they are 10 ms apart
  EXPECT_EQ(scene.warnings[0].at, ms(1005));
  EXPECT_EQ(scene.warnings[1].at, ms(1015));
  EXPECT_EQ(scene.thinned_words(), "The scene has no room for every instant: one in 20 ms of each kind is here.");
}

TEST(Scene, ASceneThatIsFullAtItsSparsestEnds) {
  SceneLimits limits;
  limits.bytes = 1000;
  Records log(limits);
  for (int t = 0; t < 60'000; t += 10) log.image(t, {Records::track(1, 20.0, 0.0)});
  const Scene scene = log.sink.finished();
  EXPECT_TRUE(scene.cut);
  EXPECT_EQ(scene.spacing, SceneSink::kSparsest);
  EXPECT_EQ(scene.images.size(), 1000u / 30u + 1u);  // the one that was too much is the last
  EXPECT_THAT(scene.thinned_words(), HasSubstr("The scene ends at 10.6 s, the drive at 60 s."));
}

TEST(Scene, PackedNumbersComeBack) {
  Records log;
  log.truth(500, -30.125);
  log.image(520, {Records::track(7, 700.0, -80.5), Records::track(300, 29.0, 1e6)});
  log.use(530, 300, true);
  const nlohmann::ordered_json json = packed(log.sink.finished(), synthetic_names(), "tt", 2);
  EXPECT_EQ(json["label"], "tt");
  const double unit = json["unit"];
  EXPECT_NEAR(unit, 700.0 / 32000.0, 1e-12);  // a centimetre does not reach so far
  EXPECT_THAT(decoded<double>(json["truth"]["at"]), Pointwise(DoubleNear(1e-12), {0.5, 1.500000001}));  // its end
  EXPECT_NEAR(decoded<std::int16_t>(json["truth"]["x"])[0] * unit, -30.125, unit);
  EXPECT_THAT(decoded<std::uint16_t>(json["truth"]["sizes"]["length"]), ElementsAre(440));
  const auto& images = json["images"];
  EXPECT_THAT(decoded<std::uint16_t>(images["count"]), ElementsAre(2, 0));
  EXPECT_THAT(decoded<std::uint16_t>(images["id"]), ElementsAre(7, 300));
  EXPECT_THAT(decoded<std::int16_t>(images["speed"]), ElementsAre(-8050, 32767));  // the end of its type
  EXPECT_THAT(decoded<std::uint16_t>(json["warnings"]["word"]), ElementsAre(0));
  EXPECT_EQ(json["warnings"]["words"][0], "gap of 1.2 s");
  EXPECT_THAT(json["sensors"][0]["edge"], SizeIs(34));
  EXPECT_THAT(json["sensors"][0]["lines"], SizeIs(2));  // a cross
  EXPECT_FALSE(json["sensors"][0]["closed"]);
  EXPECT_THAT(json["sensors"][1]["edge"], IsEmpty());
  EXPECT_THAT(json["lists"], SizeIs(2));
}

// The page's script shows the newest moment, whatever its age.
TEST(Scene, APackedMomentThatEndsBeforeTheNextIsFollowedByAnEmptyOne) {
  Records log;
  for (int t : {1000, 1200, 1600}) log.observation(t, 0, static_cast<std::uint32_t>(t), 28.0);
  const Scene scene = log.sink.finished();
  const nlohmann::ordered_json list = packed(scene, synthetic_names(), "tt", 0)["lists"][0];
  EXPECT_THAT(decoded<double>(list["at"]), Pointwise(DoubleNear(1e-12), {1.0, 1.2, 1.500000001, 1.6, 1.900000001}));
  EXPECT_THAT(decoded<std::uint16_t>(list["count"]), ElementsAre(1, 1, 0, 1, 0));
  EXPECT_THAT(view_at(scene, ms(1500)).lists[0], SizeIs(1));
  EXPECT_THAT(view_at(scene, ms(1501)).lists[0], IsEmpty());
}

TEST(Scene, AStillShowsEachPartOnce) {
  Records log;
  log.truth(1000, 30.0);
  log.truth(1000, 50.0, 4);
  log.image(1000, {Records::track(7, 29.0, 10.0), Records::track(8, 52.0, 0.0)});
  log.observation(1010, 0, 1, 28.0);
  log.observation(1010, 1, 1, 49.0);
  log.use(1020, 8, true);
  const Scene scene = log.sink.finished();
  const std::string svg = scene_svg(scene, ms(1040), synthetic_names(), "drive <1>");
  EXPECT_THAT(svg, HasSubstr("drive &lt;1&gt;, at 1.040 s"));
  EXPECT_EQ(count(svg, "class=\"truth\""), 2u);
  EXPECT_EQ(count(svg, "class=\"track\""), 2u);
  EXPECT_EQ(count(svg, "class=\"ellipse\""), 2u);
  EXPECT_EQ(count(svg, "class=\"velocity\""), 1u);  // the other stands still
  EXPECT_EQ(count(svg, "class=\"observation\""), 2u);
  EXPECT_EQ(count(svg, "class=\"warning\""), 1u);
  EXPECT_EQ(count(svg, ">8: gap of 1.2 s</text>"), 1u);
  EXPECT_EQ(count(svg, ">7</text>"), 1u);
  EXPECT_EQ(count(svg, "class=\"field\""), 2u);  // the laser's: ground and edge
  EXPECT_EQ(svg, scene_svg(scene, ms(1040), synthetic_names(), "drive <1>"));
  EXPECT_THAT(scene_svg(scene, ms(3000), synthetic_names(), ""), HasSubstr("has no object, no track"));
}

}  // namespace
}  // namespace ttf::report::scene
