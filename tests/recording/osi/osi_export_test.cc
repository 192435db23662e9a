// A drive as OSI messages: in a log's file and as `.osi`, read back by our own readers and by the schemas in the file.
#include "recording/osi/osi_export.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <map>
#include <numbers>
#include <vector>

#include "core/file_bytes.h"
#include "recording/log/reader.h"
#include "recording/log/writer.h"
#include "recording/mcap/reader.h"
#include "recording/merge/merge.h"
#include "recording/osi/osi.pb.h"
#include "recording/osi/truth_trace.h"
#include "recording/records/tee.h"

namespace ttf::recording::osi {
namespace {

constexpr double kHeading = 0.3, kSpeed = 8.0;

records::Stamp stamp_at(std::int64_t ms) {
  records::Stamp stamp;
  stamp.true_time = TrueTime{} + Duration::milliseconds(ms);
  stamp.local = LocalTime{} + Duration::milliseconds(ms);
  stamp.global = GlobalTime{} + Duration::milliseconds(ms - 5);  // the node's clock is 5 ms behind
  return stamp;
}

// Two objects whose truth is recorded every 20 ms, and an image of one of them.
void drive(records::Sink& out) {
  for (std::uint32_t k = 0; k < 5; ++k) {
    for (std::uint16_t o = 0; o < 2; ++o) {
      records::TruthState state;
      state.at = TrueTime{} + Duration::milliseconds(1000 + 20 * k);
      state.object = ObjectId{o};
      state.x = 20.0 + kSpeed * std::cos(kHeading) * 0.02 * k;
      state.y = 3.0 * o + kSpeed * std::sin(kHeading) * 0.02 * k;
      state.heading = kHeading;
      state.speed = kSpeed;
      state.acceleration = 0.5;
      state.yaw_rate = 0.01;
      state.length = 4.5;
      state.width = 1.8;
      out.on(state);
    }
    records::ImageObject track;
    track.track = TrackId{12};
    track.x = 20.5;
    track.y = 0.1;
    track.heading = kHeading;
    track.speed = kSpeed;
    track.length = 4.0;
    track.width = 1.7;
    track.sigma_x = 0.2;
    track.sigma_y = 0.1;
    track.sigma_heading = 0.05;
    track.sigma_speed = 0.4;
    track.status = k == 4 ? records::ImageStatus::kCoasting : records::ImageStatus::kConfirmed;
    records::ImageWritten image;
    image.stamp = stamp_at(1000 + 20 * k);
    image.sequence = k;
    image.valid_at = image.stamp.global + Duration::milliseconds(40);
    image.newest_measurement = image.stamp.global - Duration::milliseconds(30);
    image.objects = std::span(&track, 1);
    out.on(image);
  }
}

struct File final : mcap::McapHandler {
  void on_metadata(std::string_view name, const std::vector<std::pair<std::string, std::string>>& entries) override {
    metadata[std::string(name)] = entries;
  }
  void on_attachment(std::string_view, std::string_view, std::string_view) override {}
  void on_schema(std::uint16_t id, std::string_view name) override { schemas[id] = name; }
  void on_channel(std::uint16_t id, std::uint16_t schema) override { channels[id] = schemas[schema]; }
  bool on_message(std::uint16_t channel, std::uint64_t at, std::string_view payload) override {
    messages[channels[channel]].emplace_back(at, payload);
    return true;
  }
  std::map<std::string, std::vector<std::pair<std::string, std::string>>> metadata;
  std::map<std::uint16_t, std::string> schemas, channels;
  std::map<std::string, std::vector<std::pair<std::uint64_t, std::string>>> messages;
};

// The log of the drive, with its trace.
std::string log_and_trace() {
  const std::string path = (std::filesystem::temp_directory_path() / "ttfusion_osi_export_test.mcap").string();
  {
    log::LogManifest manifest;
    manifest.scenario_name = "street";
    log::LogWriter log(path, manifest);
    const OsiChannels channels = declare_osi(log);
    OsiExport trace([&](TrueTime at, std::string_view m) { log.add_foreign(channels.sensor_data, at, m); },
                    [&](TrueTime at, std::string_view m) { log.add_foreign(channels.ground_truth, at, m); });
    records::Tee both({&log, &trace});
    drive(both);
    trace.finish();
    log.close();
    EXPECT_EQ(trace.counts().images, 5u);
    EXPECT_EQ(trace.counts().truths, 5u);
    EXPECT_EQ(trace.counts().left_out, 0u);
  }
  const std::string bytes = read_file(path);
  std::filesystem::remove(path);
  return bytes;
}

TEST(OsiExport, IsALogAllTheSame) {
  const std::string bytes = log_and_trace();
  records::Sink none;
  const log::LogInfo info = log::read_log_bytes(bytes, "a.mcap", none);
  EXPECT_EQ(info.warning, "");
  EXPECT_EQ(info.content_hash, info.stated_content_hash);
  EXPECT_EQ(info.count(records::kKindOf<records::TruthState>), 10u);
  EXPECT_EQ(info.count(records::kKindOf<records::ImageWritten>), 5u);
  std::vector<merge::StoredLog> logs;
  logs.emplace_back(bytes, "a.mcap");
  const merge::MergedLogs merged(std::move(logs));
  EXPECT_THAT(merged.warnings(), testing::IsEmpty());
  EXPECT_EQ(merged.content_hash().value(), info.content_hash);
}

TEST(OsiExport, HasTheFactsThatOsiAsksOfAFile) {
  File file;
  mcap::walk_mcap(log_and_trace(), file);
  std::map<std::string, std::string> facts;
  for (const auto& [key, value] : file.metadata["net.asam.osi.trace"]) facts[key] = value;
  for (const char* const key : {"version", "min_osi_version", "max_osi_version"}) EXPECT_EQ(facts[key], "3.8.0") << key;
  for (const char* const key : {"min_protobuf_version", "max_protobuf_version"})
    EXPECT_THAT(facts[key], testing::MatchesRegex("[0-9]+\\.[0-9]+\\.[0-9]+")) << key;
  EXPECT_THAT(osi_file_name("gt", 12, "a street/tt"),
              testing::MatchesRegex("19700101T000000Z_gt_380_[0-9]+_12_a_street_tt\\.osi"));
  ASSERT_EQ(file.messages["osi3.SensorData"].size(), 5u);
  for (const auto& [at, message] : file.messages["osi3.SensorData"]) {
    osi3::SensorData data;
    ASSERT_TRUE(data.ParseFromString(message));
    EXPECT_EQ(static_cast<std::int64_t>(at), data.timestamp().seconds() * 1'000'000'000 + data.timestamp().nanos());
  }
}

TEST(OsiExport, SensorDataHasTheImagesTracks) {
  File file;
  mcap::walk_mcap(log_and_trace(), file);
  osi3::SensorData data;
  ASSERT_TRUE(data.ParseFromString(file.messages["osi3.SensorData"][1].second));
  EXPECT_EQ(data.timestamp().seconds(), 1);
  EXPECT_EQ(data.timestamp().nanos(), 60'000'000u);  // in true time: 20 ms + 40 ms
  EXPECT_EQ(data.last_measurement_time().nanos(), 990'000'000u);
  EXPECT_EQ(data.moving_object_header().measurement_time().nanos(), 990'000'000u);
  EXPECT_EQ(data.moving_object_header().cycle_counter(), 1u);
  ASSERT_EQ(data.moving_object_size(), 1);
  const osi3::DetectedMovingObject& object = data.moving_object(0);
  EXPECT_EQ(object.header().tracking_id().value(), 12u);
  EXPECT_EQ(object.header().measurement_state(), osi3::DetectedItemHeader::MEASUREMENT_STATE_MEASURED);
  EXPECT_FALSE(object.header().has_existence_probability());
  EXPECT_EQ(object.base().position().x(), 20.5);
  EXPECT_NEAR(object.base().velocity().x(), kSpeed * std::cos(kHeading), 1e-12);
  // The covariance of (v cos h, v sin h) is J diag(sigma_v^2, sigma_h^2) J^T.
  const double c = std::cos(kHeading), s = std::sin(kHeading);
  EXPECT_NEAR(std::pow(object.base_rmse().velocity().x(), 2), std::pow(c * 0.4, 2) + std::pow(kSpeed * s * 0.05, 2),
              1e-12);
  EXPECT_NEAR(std::pow(object.base_rmse().velocity().y(), 2), std::pow(s * 0.4, 2) + std::pow(kSpeed * c * 0.05, 2),
              1e-12);
  EXPECT_EQ(object.base_rmse().position().x(), 0.2);
  EXPECT_EQ(object.base_rmse().orientation().yaw(), 0.05);
  ASSERT_TRUE(data.ParseFromString(file.messages["osi3.SensorData"][4].second));
  EXPECT_EQ(data.moving_object(0).header().measurement_state(), osi3::DetectedItemHeader::MEASUREMENT_STATE_PREDICTED);
}

TEST(OsiExport, GroundTruthIsReadBack) {
  const TruthTrace trace = parse_truth_trace(log_and_trace(), "a.mcap");
  EXPECT_EQ(trace.length(), Duration::milliseconds(80));
  ASSERT_TRUE(trace.host) << "it stands at the origin";
  EXPECT_EQ(trace.host->vehicle.id, kHostVehicle);
  EXPECT_EQ(trace.host->vehicle.lives[0].states[4].x, -trace.host->rear_x);
  ASSERT_EQ(trace.objects.size(), 2u);
  const TracedObject& object = trace.objects[1];
  EXPECT_EQ(object.id, 1u);
  EXPECT_EQ(object.length, 4.5);
  const TracedState& last = object.lives[0].states[4];
  EXPECT_DOUBLE_EQ(last.x, 20.0 + kSpeed * std::cos(kHeading) * 0.08);
  EXPECT_DOUBLE_EQ(last.vy, kSpeed * std::sin(kHeading));
  const double centripetal = kSpeed * 0.01;
  EXPECT_DOUBLE_EQ(last.ax, 0.5 * std::cos(kHeading) - centripetal * std::sin(kHeading));
  EXPECT_DOUBLE_EQ(last.ay, 0.5 * std::sin(kHeading) + centripetal * std::cos(kHeading));
  EXPECT_EQ(last.yaw_rate, 0.01);
  // The same as `.osi`.
  std::string bytes;
  OsiExport files([](TrueTime, std::string_view) {}, [&](TrueTime, std::string_view m) { bytes += framed(m); });
  drive(files);
  files.finish();
  const TruthTrace again = parse_truth_trace(bytes, "a.osi");
  EXPECT_EQ(again.instants, trace.instants);
  EXPECT_EQ(again.objects[1].lives[0].states[4].x, last.x);
}

// A vehicle drives on a circle. The middle of its box is before its rear axle.
TEST(OsiExport, AVehicleThatTurnsHasTheCentripetalAcceleration) {
  records::EgoTruth ego;
  ego.at = TrueTime{} + Duration::milliseconds(1000);
  ego.heading = 0.5 * std::numbers::pi;
  ego.vx = 10.0;
  ego.yaw_rate = 0.4;
  std::string bytes;
  OsiExport turning([](TrueTime, std::string_view) {}, [&](TrueTime, std::string_view m) { bytes += framed(m); });
  turning.on(ego);
  drive(turning);
  turning.finish();
  const TruthTrace read = parse_truth_trace(bytes, "a.osi");
  const TracedState& host = read.host->vehicle.lives[0].states[0];
  EXPECT_NEAR(host.ax, -0.4 * 10.0, 1e-12);  // to the left of a vehicle along y
  EXPECT_NEAR(host.ay, 0.4 * 0.4 * read.host->rear_x, 1e-12);
}

// After a restart the fusion node's images may begin anew, earlier than the last.
TEST(OsiExport, StampsAscend) {
  std::vector<TrueTime> at;
  OsiExport trace([&](TrueTime t, std::string_view) { at.push_back(t); }, [](TrueTime, std::string_view) {});
  for (const std::int64_t ms : {1000, 1020, 1010, 1040}) {
    records::ImageWritten image;
    image.stamp = stamp_at(ms);
    image.valid_at = image.stamp.global;
    image.newest_measurement = image.stamp.global;
    trace.on(image);
  }
  trace.finish();
  EXPECT_EQ(at.size(), 3u);
  EXPECT_EQ(trace.counts().left_out, 1u);
}

}  // namespace
}  // namespace ttf::recording::osi
