// Scenes from records with an exactly known result, and from records that no drive can have.
#include "recording/exports/viewer/foxglove_export.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <numbers>
#include <tuple>

#include "recording/exports/viewer/plots.pb.h"
#include "tests/recording/exports/viewer/scene_file.h"
#include "tests/recording/log/log_fixture.h"
#include "tests/recording/record_text.h"

namespace ttf::recording::exports::viewer {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::Pair;
using testing::SizeIs;

constexpr NodeId kFusion{5}, kFeature{6};
constexpr std::int64_t kMs = 1'000'000;

std::vector<scene::ViewedSensor> two_sensors() {
  return {{"laser", "#d55e00", scene::Pose{3.5, 0.5, std::numbers::pi / 2.0}, scene::ViewedField{1.0, 0.0, 120.0}},
          {"camera", "#0072b2", std::nullopt, std::nullopt}};
}

// Every instant is the same on all clocks.
struct Scene {
  std::string path = log::scratch("scene.mcap");
  FoxgloveExport out;
  SceneCounts counts;

  explicit Scene(std::vector<scene::ViewedSensor> sensors = {}) : out(path, std::move(sensors)) {}

  static records::Stamp at(NodeId node, std::int64_t ns) { return {{ns}, {ns}, {ns}, node}; }

  void truth(std::int64_t ns, int object, double x, NodeId node = kFeature) {
    records::TruthState state;
    state.at = {ns};
    state.object = static_cast<ObjectId>(object);
    state.x = x;
    state.y = -2.0;
    state.heading = std::numbers::pi / 2.0;
    state.length = 4.4;
    state.width = 1.8;
    state.node = node;
    out.on(state);
  }
  void image(std::int64_t written, std::int64_t valid, const std::vector<records::ImageObject>& objects) {
    records::ImageWritten image;
    image.stamp = at(kFusion, written);
    image.valid_at = {valid};
    image.objects = objects;
    out.on(image);
  }
  void use(std::int64_t ns, std::int64_t valid, const std::vector<records::FeatureObject>& objects) {
    records::FeatureUsed use;
    use.stamp = at(kFeature, ns);
    use.image_sequence = 9;
    use.image_valid_at = {valid};
    use.objects = objects;
    out.on(use);
  }
  void observation(std::int64_t ns, std::int64_t measured, int sensor, std::uint16_t index, double x) {
    records::ObservationSeen seen;
    seen.stamp = at(kFusion, ns);
    seen.id = {static_cast<SensorId>(sensor), 4};
    seen.measured = {measured};
    seen.index = index;
    seen.x = x;
    out.on(seen);
  }
  SceneFile finished() {
    counts = out.finish();
    std::ifstream file(path, std::ios::binary);
    return SceneFile(std::string{std::istreambuf_iterator<char>(file), {}});
  }
};

records::ImageObject object(int track, double x, double speed = 0.0) {
  records::ImageObject one;
  one.track = static_cast<TrackId>(track);
  one.x = x;
  one.speed = speed;
  one.length = 4.0;
  one.width = 2.0;
  one.sigma_x = 0.5;
  one.sigma_y = 0.25;
  one.status = records::ImageStatus::kConfirmed;
  return one;
}

std::vector<std::string> deleted(const ::foxglove::SceneUpdate& update) {
  std::vector<std::string> ids;
  for (const auto& one : update.deletions()) ids.push_back(one.id());
  return ids;
}
std::vector<std::string> ids(const ::foxglove::SceneUpdate& update) {
  std::vector<std::string> all;
  for (const auto& one : update.entities()) all.push_back(one.id());
  return all;
}

TEST(FoxgloveExport, ABoxHasTheTruthsPoseAndSize) {
  Scene scene;
  scene.truth(1'500 * kMs, 2, 30.0);
  scene.truth(1'500 * kMs, 3, 50.0);
  scene.truth(1'500 * kMs, 2, 31.0, kFusion);  // another node's record of the same instant
  const SceneFile file = scene.finished();
  EXPECT_THAT(file.problems, IsEmpty());
  const auto updates = file.of("/truth");
  ASSERT_THAT(updates, SizeIs(1));
  EXPECT_EQ(updates[0].first, 1'500u * kMs);
  EXPECT_THAT(ids(updates[0].second), ElementsAre("object 2", "object 3"));
  const ::foxglove::SceneEntity& entity = updates[0].second.entities(0);
  EXPECT_EQ(entity.frame_id(), "vehicle");
  EXPECT_EQ(entity.timestamp().seconds(), 1);
  EXPECT_EQ(entity.timestamp().nanos(), 500 * kMs);
  ASSERT_EQ(entity.cubes_size(), 1);
  const ::foxglove::CubePrimitive& box = entity.cubes(0);
  EXPECT_EQ(box.pose().position().x(), 30.0);
  EXPECT_EQ(box.pose().position().y(), -2.0);
  EXPECT_EQ(box.pose().position().z(), 0.75);  // half of 1.5 m: it stands on the plane
  EXPECT_EQ(box.size().x(), 4.4);
  EXPECT_EQ(box.size().y(), 1.8);
  EXPECT_EQ(box.size().z(), 1.5);
  EXPECT_NEAR(box.pose().orientation().z(), std::sqrt(0.5), 1e-12);  // a quarter turn to the left
  EXPECT_NEAR(box.pose().orientation().w(), std::sqrt(0.5), 1e-12);
  EXPECT_EQ(box.pose().orientation().x(), 0.0);
  EXPECT_EQ(entity.texts(0).text(), "object 2");
  EXPECT_EQ(scene.counts.truths, 1u);
}

TEST(FoxgloveExport, TracksAreShownAtTheInstantOfUseWithBoxIdVelocityAndEllipse) {
  Scene scene;
  scene.image(10 * kMs, 12 * kMs, {object(7, 40.0, -3.0)});
  const SceneFile file = scene.finished();
  EXPECT_THAT(file.problems, IsEmpty());
  const auto updates = file.of("/tracks");
  ASSERT_THAT(updates, SizeIs(1));
  EXPECT_EQ(updates[0].first, 12u * kMs);
  const ::foxglove::SceneEntity& track = updates[0].second.entities(0);
  EXPECT_EQ(track.id(), "track 7");
  EXPECT_EQ(track.texts(0).text(), "7");
  EXPECT_EQ(track.cubes(0).size().x(), 4.0);
  EXPECT_EQ(track.metadata(0).value(), "confirmed");
  const ::foxglove::ArrowPrimitive& arrow = track.arrows(0);
  EXPECT_DOUBLE_EQ(arrow.shaft_length() + arrow.head_length(), 3.0);  // the way of one second
  EXPECT_NEAR(arrow.pose().orientation().z(), 1.0, 1e-12);            // it falls back
  ASSERT_EQ(track.lines_size(), 1);
  EXPECT_EQ(track.lines(0).type(), ::foxglove::LinePrimitive::LINE_LOOP);
  double ahead = 0.0, aside = 0.0;
  for (const auto& point : track.lines(0).points()) {
    ahead = std::max(ahead, point.x() - 40.0);
    aside = std::max(aside, point.y());
  }
  EXPECT_NEAR(ahead, 1.0, 1e-12);  // two sigma of 0.5 m
  EXPECT_NEAR(aside, 0.5, 1e-12);
}

TEST(FoxgloveExport, ATrackThatEndsIsDeleted) {
  Scene scene;
  scene.image(10 * kMs, 12 * kMs, {object(3, 20.0), object(7, 40.0)});
  scene.image(50 * kMs, 52 * kMs, {object(7, 41.0)});
  scene.image(90 * kMs, 92 * kMs, {});
  scene.image(130 * kMs, 132 * kMs, {});
  const SceneFile file = scene.finished();
  EXPECT_THAT(file.problems, IsEmpty());
  const auto updates = file.of("/tracks");
  ASSERT_THAT(updates, SizeIs(4));
  EXPECT_THAT(deleted(updates[0].second), IsEmpty());
  EXPECT_THAT(deleted(updates[1].second), ElementsAre("track 3"));
  EXPECT_EQ(updates[1].second.deletions(0).type(), ::foxglove::SceneEntityDeletion::MATCHING_ID);
  EXPECT_EQ(updates[1].second.deletions(0).timestamp().nanos(), 52 * kMs);
  EXPECT_THAT(deleted(updates[2].second), ElementsAre("track 7"));
  EXPECT_THAT(deleted(updates[3].second), IsEmpty());
  // If images end altogether, the viewer removes the tracks itself.
  EXPECT_EQ(updates[0].second.entities(0).lifetime().seconds(), 1);
}

TEST(FoxgloveExport, AWarningIsAnOutlineAndGoesWithItsReason) {
  Scene scene;
  records::FeatureObject warned{object(7, 40.0), 2.0, 1.25, true};
  scene.use(20 * kMs, 12 * kMs, {warned});
  warned.warning = false;
  scene.use(60 * kMs, 52 * kMs, {warned});
  const SceneFile file = scene.finished();
  EXPECT_THAT(file.problems, IsEmpty());
  const auto updates = file.of("/warnings");
  ASSERT_THAT(updates, SizeIs(2));
  const ::foxglove::SceneEntity& outline = updates[0].second.entities(0);
  EXPECT_EQ(outline.texts(0).text(), "collision in 1.2 s");
  ASSERT_EQ(outline.lines(0).points_size(), 4);
  EXPECT_EQ(outline.lines(0).points(0).x(), 42.0);
  EXPECT_EQ(outline.lines(0).points(0).y(), 1.0);
  EXPECT_THAT(deleted(updates[1].second), ElementsAre("track 7"));
}

TEST(FoxgloveExport, AFieldIsInItsSensorsFrame) {
  Scene scene(two_sensors());
  const SceneFile file = scene.finished();
  EXPECT_THAT(file.problems, IsEmpty());
  const auto frames = file.of<::foxglove::FrameTransforms>("/transforms");
  ASSERT_THAT(frames, SizeIs(1));
  ASSERT_EQ(frames[0].second.transforms_size(), 1);  // nothing is known of the camera
  const ::foxglove::FrameTransform& laser = frames[0].second.transforms(0);
  EXPECT_EQ(laser.parent_frame_id(), "vehicle");
  EXPECT_EQ(laser.child_frame_id(), "vehicle/laser");
  EXPECT_EQ(laser.translation().x(), 3.5);
  EXPECT_EQ(laser.translation().y(), 0.5);
  EXPECT_NEAR(laser.rotation().z(), std::sqrt(0.5), 1e-12);
  const auto fields = file.of("/fields");
  ASSERT_THAT(fields, SizeIs(1));
  const ::foxglove::SceneEntity& field = fields[0].second.entities(0);
  EXPECT_EQ(field.frame_id(), "vehicle/laser");
  EXPECT_EQ(field.lifetime().seconds() + field.lifetime().nanos(), 0);  // it stays
  const auto& points = field.lines(0).points();
  EXPECT_NEAR(points[0].x(), 120.0 * std::cos(1.0), 1e-9);
  EXPECT_NEAR(points[0].y(), -120.0 * std::sin(1.0), 1e-9);
  EXPECT_EQ(points[points.size() - 1].x(), 0.0);
  EXPECT_EQ(scene.counts.fields, 1u);
}

TEST(FoxgloveExport, ObservationsAreShownWhenTheyWereMeasured) {
  Scene scene(two_sensors());
  scene.observation(80 * kMs, 30 * kMs, 0, 0, 20.0);
  scene.observation(80 * kMs, 30 * kMs, 0, 1, 40.0);
  scene.observation(80 * kMs, 40 * kMs, 1, 0, 20.5);
  scene.observation(90 * kMs, 40 * kMs, 2, 0, 20.5);  // a sensor without a name
  const SceneFile file = scene.finished();
  EXPECT_THAT(file.problems, IsEmpty());
  const auto laser = file.of("/observations/laser"), camera = file.of("/observations/camera");
  ASSERT_THAT(laser, SizeIs(1));
  ASSERT_THAT(camera, SizeIs(1));
  EXPECT_EQ(laser[0].first, 30u * kMs);
  EXPECT_EQ(camera[0].first, 40u * kMs);
  EXPECT_EQ(laser[0].second.entities(0).lines(0).points_size(), 2 * 4);  // a cross has two strokes
  EXPECT_EQ(laser[0].second.entities(0).lines(0).type(), ::foxglove::LinePrimitive::LINE_LIST);
  EXPECT_EQ(scene.counts.observations, 2u);
  EXPECT_EQ(scene.counts.unnamed, 1u);
}

TEST(FoxgloveExport, AgesAndErrorsAreNumbers) {
  Scene scene(two_sensors());
  scene.use(20 * kMs, 12 * kMs, {{object(7, 40.0), 1.0, 1.0, true}, {object(8, 60.0), 1.0, 1.0, false}});
  scene.out.age({20 * kMs}, SensorId{1}, Duration::microseconds(12'500));
  const ObjectErrors errors[] = {{ObjectId{0}, 3.0, 4.0, 0.0, 1.0, 2.5}, {ObjectId{1}, 0.0, 1.0, 0.0, 0.0, 0.0}};
  scene.out.errors({20 * kMs}, errors, 1, 2);
  scene.out.errors({60 * kMs}, {}, 2, 0);
  const SceneFile file = scene.finished();
  EXPECT_THAT(file.problems, IsEmpty());
  const auto use = file.of<ttfusion::plots::ImageUse>("/image_use");
  ASSERT_THAT(use, SizeIs(1));
  EXPECT_EQ(use[0].second.age_ms(), 8.0);
  EXPECT_EQ(use[0].second.image(), 9u);
  EXPECT_EQ(use[0].second.objects(), 2u);
  EXPECT_EQ(use[0].second.warnings(), 1u);
  const auto age = file.of<ttfusion::plots::Age>("/ages/camera");
  ASSERT_THAT(age, SizeIs(1));
  EXPECT_EQ(age[0].second.age_ms(), 12.5);
  EXPECT_THAT(file.of<ttfusion::plots::Age>("/ages/laser"), IsEmpty());
  const auto found = file.of<ttfusion::plots::Errors>("/errors");
  ASSERT_THAT(found, SizeIs(2));
  EXPECT_DOUBLE_EQ(found[0].second.position_m(), std::sqrt(13.0));
  EXPECT_DOUBLE_EQ(found[0].second.velocity_mps(), std::sqrt(0.5));
  EXPECT_EQ(found[0].second.missed(), 1u);
  EXPECT_EQ(found[0].second.spurious(), 2u);
  EXPECT_EQ(found[0].second.objects(0).y_m(), 4.0);
  EXPECT_TRUE(std::isnan(found[1].second.position_m()));
}

// Errors are known when the next use comes, observations when they are fused: both are about an earlier instant.
TEST(FoxgloveExport, StampsNeverGoBack) {
  Scene scene(two_sensors());
  scene.image(10 * kMs, 50 * kMs, {});
  scene.use(20 * kMs, 12 * kMs, {});
  scene.observation(40 * kMs, 5 * kMs, 0, 0, 20.0);
  scene.use(60 * kMs, 50 * kMs, {});
  scene.out.errors({20 * kMs}, {}, 0, 0);
  scene.use(9'000 * kMs, 8'990 * kMs, {});
  scene.use(9'500 * kMs, 9'490 * kMs, {});
  scene.use(20'000 * kMs, 19'990 * kMs, {});
  scene.out.errors({60 * kMs}, {}, 0, 0);  // far too late
  const SceneFile file = scene.finished();
  EXPECT_THAT(file.problems, IsEmpty());
  std::vector<std::pair<std::string, std::uint64_t>> found;
  for (const auto& message : file.messages)
    if (message.topic != "/warnings" && message.at > 0) found.emplace_back(message.topic, message.at / kMs);
  EXPECT_THAT(found, ElementsAre(Pair("/observations/laser", 5), Pair("/image_use", 20), Pair("/errors", 20),
                                 Pair("/tracks", 50), Pair("/image_use", 60), Pair("/image_use", 9'000),
                                 Pair("/image_use", 9'500), Pair("/errors", 9'500), Pair("/image_use", 20'000)));
}

TEST(FoxgloveExport, ALogWithoutRecordsIsAWholeFile) {
  Scene scene;
  const SceneFile file = scene.finished();
  EXPECT_THAT(file.problems, IsEmpty());
  EXPECT_THAT(file.messages, IsEmpty());
  EXPECT_EQ(file.topics.at("/tracks"), "foxglove.SceneUpdate");
  EXPECT_EQ(file.topics.at("/transforms"), "foxglove.FrameTransforms");
  EXPECT_EQ(scene.counts.truths + scene.counts.images + scene.counts.uses, 0u);
}

TEST(FoxgloveExport, AnyRecordsGiveASoundFileAndTheSameEachTime) {
  const auto any = [] {
    Scene scene(two_sensors());
    for (const Values values : {Values::kSmallest, Values::kZero, Values::kDrawn, Values::kLargest})
      for (std::uint32_t i = 0; i < 4 * records::kKindCount; ++i)
        emit(scene.out, log::kind_of(i), values, i, i * 10 * kMs);
    SceneFile file = scene.finished();
    EXPECT_THAT(file.problems, IsEmpty());
    std::string all;
    for (const auto& message : file.messages) all += message.topic + std::to_string(message.at) + message.bytes;
    return all;
  };
  EXPECT_EQ(any(), any());
}

TEST(FoxgloveExport, AnUnfinishedFileDoesNotStay) {
  std::string path;
  {
    Scene scene;
    path = scene.path;
    EXPECT_TRUE(std::filesystem::exists(path));
  }
  EXPECT_FALSE(std::filesystem::exists(path));
}

TEST(FoxgloveExport, ADrivingVehicleSeesAStandingObjectComeNearer) {
  std::vector<scene::ViewedSensor> sensors = two_sensors();
  sensors.push_back({"odometry", "#aa3377", std::nullopt, std::nullopt, true});
  Scene scene(std::move(sensors));
  records::OdometryTaken taken;
  taken.stamp = Scene::at(kFusion, 9 * kMs);
  taken.speed = 8.0;
  scene.out.on(taken);
  scene.image(10 * kMs, 12 * kMs, {object(7, 40.0)});
  const SceneFile file = scene.finished();
  EXPECT_THAT(file.problems, IsEmpty());
  const ::foxglove::ArrowPrimitive arrow = file.of("/tracks").at(0).second.entities(0).arrows(0);
  EXPECT_DOUBLE_EQ(arrow.shaft_length() + arrow.head_length(), 8.0);
  EXPECT_NEAR(std::abs(arrow.pose().orientation().z()), 1.0, 1e-12);  // backwards
  EXPECT_TRUE(file.topics.contains("/observations/laser"));
  EXPECT_FALSE(file.topics.contains("/observations/odometry"));
}

// The numbers are those of npm @foxglove/schemas 2.1.0. foxglove_schemas_test.sh compares with the package itself.
TEST(FoxgloveExport, SchemasAreFoxglovesByNameAndNumber) {
  Scene scene(two_sensors());
  const SceneFile file = scene.finished();
  const std::vector<std::tuple<std::string, std::string, std::vector<std::string>>> published = {
      {"SceneUpdate", "SceneUpdate", {"deletions", "entities"}},
      {"SceneUpdate", "SceneEntityDeletion", {"timestamp", "type", "id"}},
      {"SceneUpdate",
       "SceneEntity",
       {"timestamp", "frame_id", "id", "lifetime", "frame_locked", "metadata", "arrows", "cubes", "spheres",
        "cylinders", "lines", "triangles", "texts", "models"}},
      {"SceneUpdate", "CubePrimitive", {"pose", "size", "color"}},
      {"SceneUpdate",
       "ArrowPrimitive",
       {"pose", "shaft_length", "shaft_diameter", "head_length", "head_diameter", "color"}},
      {"SceneUpdate", "TextPrimitive", {"pose", "billboard", "font_size", "scale_invariant", "color", "text"}},
      {"SceneUpdate",
       "LinePrimitive",
       {"type", "pose", "thickness", "scale_invariant", "points", "color", "colors", "indices"}},
      {"SceneUpdate", "Pose", {"position", "orientation"}},
      {"SceneUpdate", "Quaternion", {"x", "y", "z", "w"}},
      {"SceneUpdate", "Color", {"r", "g", "b", "a"}},
      {"FrameTransforms", "FrameTransforms", {"transforms"}},
      {"FrameTransforms",
       "FrameTransform",
       {"timestamp", "parent_frame_id", "child_frame_id", "translation", "rotation"}}};
  for (const auto& [schema, name, fields] : published) {
    const auto* root = file.type("foxglove." + schema);
    ASSERT_NE(root, nullptr) << schema;
    const auto* type = root->file()->pool()->FindMessageTypeByName("foxglove." + name);
    ASSERT_NE(type, nullptr) << name;
    ASSERT_EQ(type->field_count(), static_cast<int>(fields.size())) << name;
    for (std::size_t f = 0; f < fields.size(); ++f) {
      const auto* field = type->FindFieldByNumber(static_cast<int>(f + 1));
      ASSERT_NE(field, nullptr) << name << ' ' << f + 1;
      EXPECT_EQ(field->name(), fields[f]) << name;
    }
  }
  const auto* line = file.type("foxglove.SceneUpdate")->file()->pool()->FindMessageTypeByName("foxglove.LinePrimitive");
  EXPECT_EQ(line->FindFieldByName("indices")->type(), google::protobuf::FieldDescriptor::TYPE_FIXED32);
  EXPECT_EQ(line->FindEnumTypeByName("Type")->FindValueByNumber(2)->name(), "LINE_LIST");
}

}  // namespace
}  // namespace ttf::recording::exports::viewer
