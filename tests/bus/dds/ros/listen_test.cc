// The shipped example as users start it, with a publisher in another process.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/bus/dds/ros/processes.h"

namespace ttf::bus::dds::ros {
namespace {

using namespace std::chrono_literals;
using nlohmann::json;

constexpr auto kPatience = 20s;
constexpr std::int64_t kPeriodMs = 50;
constexpr std::int64_t kOrigin = 1'700'000'000'250'000'000;

class RosListen : public testing::Test {
 protected:
  RosListen()
      : name_(options_of_its_own().node_name),
        talker_({TTF_ROS_TALKER, std::to_string(kRosDomain), name_, std::to_string(kPeriodMs)}, {}) {}

  std::string topic(const std::string& name) const { return "rt/" + name_ + "/" + name; }
  json sample_of(const std::string& topic, const std::function<bool(const json&)>& wanted = {}) {
    const auto found = listener_.find(
        [&](const json& line) { return is_sample_of(line, topic) && (!wanted || wanted(line)); }, kPatience);
    EXPECT_TRUE(found.has_value()) << "nothing came on " << topic;
    return found.value_or(json::object());
  }
  std::optional<json> event_of(const std::string& event, const std::string& topic) {
    return listener_.find([&](const json& line) { return is_event_of(line, event, topic); }, kPatience);
  }

  std::string name_;
  Listener listener_;
  Process talker_;
};

TEST_F(RosListen, AnImageArrivesAsItWasRecorded) {
  const json image = sample_of(topic("image"));
  const std::int64_t at = image.at("sequence_number").get<std::int64_t>() * kPeriodMs * 1'000'000;
  EXPECT_EQ(image.at("frame_id"), "sensor_car");
  EXPECT_EQ(image.at("stamp_ns"), kOrigin + at + 20'000'000);
  EXPECT_EQ(image.at("written_ns"), kOrigin + at);
  EXPECT_EQ(image.at("newest_measurement_ns"), kOrigin + at - 5'000'000);
  ASSERT_EQ(image.at("objects").size(), 2u);
  for (int i = 0; i < 2; ++i) {
    const recording::records::ImageObject object = image_object(i);
    const json expected = {{"track_id", index_of(object.track)},
                           {"status", static_cast<int>(object.status)},
                           {"x", object.x},
                           {"y", object.y},
                           {"heading", object.heading},
                           {"speed", object.speed},
                           {"acceleration", object.acceleration},
                           {"length", object.length},
                           {"width", object.width},
                           {"sigma_x", object.sigma_x},
                           {"sigma_y", object.sigma_y},
                           {"correlation_xy", object.correlation_xy},
                           {"sigma_heading", object.sigma_heading},
                           {"sigma_speed", object.sigma_speed},
                           {"sigma_acceleration", object.sigma_acceleration},
                           {"sigma_length", object.sigma_length},
                           {"sigma_width", object.sigma_width}};
    EXPECT_EQ(image.at("objects").at(static_cast<std::size_t>(i)), expected);
  }
}

TEST_F(RosListen, TheBoxesOfAnImageArrive) {
  const json boxes = sample_of(topic("image/boxes"));
  ASSERT_EQ(boxes.at("detections").size(), 2u);
  const json& second = boxes.at("detections").at(1);
  const recording::records::ImageObject object = image_object(1);
  EXPECT_EQ(second.at("id"), "101");
  EXPECT_EQ(second.at("stamp_ns"), boxes.at("stamp_ns"));
  EXPECT_EQ(second.at("position"), json({object.x, object.y, 0.0}));
  EXPECT_EQ(second.at("orientation"), json({0.0, 0.0, std::sin(object.heading / 2), std::cos(object.heading / 2)}));
  EXPECT_EQ(second.at("size"), json({object.length, object.width, 0.0}));
  ASSERT_EQ(second.at("results").size(), 1u);
  EXPECT_EQ(second.at("results").at(0).at("class_id"), "tentative");
  EXPECT_EQ(second.at("results").at(0).at("covariance").size(), 36u);
}

TEST_F(RosListen, TracksTruthAndHealthArriveAsTheyWereSent) {
  const json tracks = sample_of(topic("tracks"));
  const std::int64_t at = tracks.at("step").get<std::int64_t>() * kPeriodMs * 1'000'000;
  EXPECT_EQ(tracks.at("stamp_ns"), kOrigin + at);
  EXPECT_EQ(tracks.at("confirmed"), 1);
  EXPECT_EQ(tracks.at("tentative"), 2);
  const DrawnTrack drawn(at, 0, 31);
  EXPECT_EQ(tracks.at("tracks"), json::array({{{"track_id", 31},
                                               {"valid_at_ns", kOrigin + at - 2'000'000},
                                               {"state", drawn.state},
                                               {"covariance", drawn.covariance}}}));

  const json truth = sample_of(topic("truth/object_0"));
  EXPECT_EQ(truth.at("child_frame_id"), "object_0");
  EXPECT_EQ(truth.at("position"), json({11.5, -3.25, 0.0}));
  EXPECT_EQ(truth.at("linear"), json({27.5, 0.0, 0.0}));
  EXPECT_EQ(truth.at("angular"), json({0.0, 0.0, 0.0625}));

  const json health =
      sample_of("rt/diagnostics", [&](const json& line) { return line.at("status").at(0).at("hardware_id") == name_; });
  EXPECT_EQ(health.at("status"), json::array({{{"level", 1},
                                               {"name", "talker"},
                                               {"message", "talks"},
                                               {"hardware_id", name_},
                                               {"values", {{"says", "\"quoted\"\n"}}}}}));
}

TEST_F(RosListen, APublicationIsAnnouncedWithItsTypeDeadlineAndLease) {
  const auto publication = event_of("publication", topic("tracks"));
  ASSERT_TRUE(publication.has_value());
  EXPECT_EQ(publication->at("type"), "ttfusion_msgs::msg::dds_::TrackArray_");
  EXPECT_EQ(publication->at("deadline_ns"), 4 * kPeriodMs * 1'000'000);
  EXPECT_EQ(publication->at("lease_ns"), 1'000'000'000);
}

TEST_F(RosListen, AKilledPublisherIsNoticedByItsLease) {
  sample_of(topic("image"));
  talker_.signal(SIGKILL);
  EXPECT_EQ(talker_.wait(), -SIGKILL);
  const auto event = listener_.find(
      [&](const json& line) { return is_event_of(line, "liveliness", topic("image")) && line.at("alive") == 0; },
      kPatience);
  EXPECT_TRUE(event.has_value());
}

// Stopped for longer than its deadline: the listener reports that, and the recovery.
TEST_F(RosListen, AStoppedPublisherMissesItsDeadlineAndIsReceivedAgain) {
  const std::int64_t before = sample_of(topic("image")).at("sequence_number").get<std::int64_t>();
  talker_.signal(SIGSTOP);
  EXPECT_TRUE(event_of("deadline_missed", topic("image")).has_value());
  const auto gone = listener_.find(
      [&](const json& line) { return is_event_of(line, "liveliness", topic("image")) && line.at("alive") == 0; },
      kPatience);
  EXPECT_TRUE(gone.has_value());
  talker_.signal(SIGCONT);
  sample_of(topic("image"),
            [&](const json& line) { return line.at("sequence_number").get<std::int64_t>() > before + 10; });
}

TEST_F(RosListen, EndsOnCommand) {
  sample_of(topic("image"));
  listener_.signal(SIGTERM);
  EXPECT_EQ(listener_.wait(), 0);
}

TEST(RosListenUsage, SaysWhatItWants) {
  for (const char* domain : {"232", "x", ""}) {
    Process wrong({TTF_ROS_LISTEN, domain}, {});
    EXPECT_EQ(wrong.wait(), 2) << domain;
  }
}

}  // namespace
}  // namespace ttf::bus::dds::ros
