// A ROS 2 reader's view: names of topics and types, bytes and qualities, as another DDS participant sees
// them.
#include <dds/dds.h>
#include <dds/ddsi/ddsi_serdata.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "bus/dds/common/participant.h"
#include "bus/dds/ros/messages.h"
#include "bus/dds/ros/publisher.h"
#include "tests/bus/dds/ros/cdr.h"
#include "tests/bus/dds/ros/drawn.h"

namespace ttf::bus::dds::ros {
namespace {

// Another participant in the publisher's domain, which reads raw bytes.
class Stranger {
 public:
  Stranger() : participant_(kRosDomain, std::chrono::seconds{3}) {}

  void listen(const dds_topic_descriptor_t& type, const std::string& topic) {
    const dds_entity_t made = dds_create_topic(participant_.handle(), &type, topic.c_str(), nullptr, nullptr);
    dds_qos_t* qos = dds_create_qos();  // as ROS' readers: reliable, volatile, the last 10
    dds_qset_reliability(qos, DDS_RELIABILITY_RELIABLE, DDS_INFINITY);
    dds_qset_history(qos, DDS_HISTORY_KEEP_LAST, 10);
    reader_ = dds_create_reader(participant_.handle(), made, qos, nullptr);
    dds_delete_qos(qos);
    ASSERT_GT(reader_, 0);
    dds_subscription_matched_status_t matched{};
    for (int i = 0; i < 500 && matched.current_count == 0; ++i, pause())
      dds_get_subscription_matched_status(reader_, &matched);
    ASSERT_EQ(matched.current_count, 1u) << topic;
  }

  // The next sample's payload, behind the four bytes that announce plain CDR.
  std::vector<std::uint8_t> next() const {
    ddsi_serdata* sample = nullptr;
    dds_sample_info_t info;
    for (int i = 0; i < 500; ++i, pause()) {
      if (dds_takecdr(reader_, &sample, 1, &info, DDS_ANY_STATE) != 1) continue;
      std::vector<std::uint8_t> bytes(ddsi_serdata_size(sample));
      ddsi_serdata_to_ser(sample, 0, bytes.size(), bytes.data());
      ddsi_serdata_unref(sample);
      EXPECT_EQ(bytes.at(0), 0u);
      EXPECT_EQ(bytes.at(1), 1u);  // CDR_LE
      bytes.erase(bytes.begin(), bytes.begin() + 4);
      return bytes;
    }
    ADD_FAILURE() << "nothing came";
    return {};
  }

  struct Endpoint {
    std::string type;
    std::unique_ptr<dds_qos_t, decltype(&dds_delete_qos)> qos;
  };
  // Entries of DDS' own topic of publications, for topics with `part` in their name.
  std::map<std::string, Endpoint> publications(const std::string& part, std::size_t count) const {
    const dds_entity_t reader =
        dds_create_reader(participant_.handle(), DDS_BUILTIN_TOPIC_DCPSPUBLICATION, nullptr, nullptr);
    std::map<std::string, Endpoint> found;
    for (int i = 0; i < 500 && found.size() < count; ++i, pause()) {
      void* sample = nullptr;
      dds_sample_info_t info;
      while (dds_take(reader, &sample, &info, 1, 1) == 1) {
        const auto& endpoint = *static_cast<const dds_builtintopic_endpoint_t*>(sample);
        if (info.valid_data && std::string(endpoint.topic_name).find(part) != std::string::npos) {
          Endpoint copy{endpoint.type_name, {dds_create_qos(), dds_delete_qos}};
          dds_copy_qos(copy.qos.get(), endpoint.qos);
          found.emplace(endpoint.topic_name, std::move(copy));
        }
        dds_return_loan(reader, &sample, 1);
      }
    }
    dds_delete(reader);
    return found;
  }

 private:
  static void pause() { std::this_thread::sleep_for(std::chrono::milliseconds{10}); }
  common::Participant participant_;
  dds_entity_t reader_ = 0;
};

// Expects `expected`, followed only by padding to four bytes.
void expect_bytes(const std::vector<std::uint8_t>& bytes, const Cdr& expected) {
  ASSERT_GE(bytes.size(), expected.bytes().size());
  EXPECT_LT(bytes.size() - expected.bytes().size(), 4u);
  const auto differs = std::mismatch(expected.bytes().begin(), expected.bytes().end(), bytes.begin()).first;
  EXPECT_EQ(differs - expected.bytes().begin(), static_cast<std::ptrdiff_t>(expected.bytes().size()));
}

// The publishers' common prefix: std_msgs/Header.
Cdr header(std::int32_t seconds, std::uint32_t nanoseconds) {
  Cdr cdr;
  cdr.time(seconds, nanoseconds).text("sensor_car");
  return cdr;
}

void put_pose(Cdr& cdr, double x, double y, double heading) {
  for (const double value : {x, y, 0.0, 0.0, 0.0, std::sin(heading / 2), std::cos(heading / 2)}) cdr.f64(value);
}

TEST(RosWire, AnImageHasTheBytesOfItsMessage) {
  const RosOptions options = options_of_its_own();
  RosPublisher publisher(options);
  Stranger stranger;
  stranger.listen(ttfusion_msgs_msg_dds__RealTimeImage__desc, "rt/" + options.node_name + "/image");
  publisher.on(DrawnImage(1'000'000'000, 17, 2).record);
  Cdr expected = header(1'700'000'001, 270'000'000);  // of use 20 ms after it was written, 1 s after the origin
  expected.u32(17).time(1'700'000'001, 250'000'000).time(1'700'000'001, 245'000'000).u32(2);
  for (int i = 0; i < 2; ++i) {
    const recording::records::ImageObject object = image_object(i);
    expected.u16(static_cast<std::uint16_t>(100 + i)).u8(static_cast<std::uint8_t>(object.status));
    for (const double value :
         {object.x, object.y, object.heading, object.speed, object.acceleration, object.length, object.width,
          object.sigma_x, object.sigma_y, object.correlation_xy, object.sigma_heading, object.sigma_speed,
          object.sigma_acceleration, object.sigma_length, object.sigma_width})
      expected.f64(value);
  }
  expect_bytes(stranger.next(), expected);
}

// Stretched four times, the second since the drive's begin has become four.
TEST(RosWire, StampsAreOnTheClockThatAStretchedDriveGoesBy) {
  RosOptions options = options_of_its_own();
  options.time_scale_ppm = 4'000'000;
  RosPublisher publisher(options);
  Stranger stranger;
  stranger.listen(ttfusion_msgs_msg_dds__RealTimeImage__desc, "rt/" + options.node_name + "/image");
  publisher.on(DrawnImage(1'000'000'000, 17, 0).record);
  Cdr expected = header(1'700'000'004, 330'000'000);  // 1.02 s times 4 after the origin, which is at 0.25 s
  expected.u32(17).time(1'700'000'004, 250'000'000).time(1'700'000'004, 230'000'000).u32(0);
  expect_bytes(stranger.next(), expected);
}

// vision_msgs/Detection3DArray of Humble: header; detections of header, results of (class_id, score, pose,
// covariance), bbox of (center, size), id.
TEST(RosWire, BoxesHaveTheBytesOfVisionMsgs4) {
  const RosOptions options = options_of_its_own();
  RosPublisher publisher(options);
  Stranger stranger;
  stranger.listen(vision_msgs_msg_dds__Detection3DArray__desc, "rt/" + options.node_name + "/image/boxes");
  publisher.on(DrawnImage(1'000'000'000, 17, 2).record);
  Cdr expected = header(1'700'000'001, 270'000'000);
  expected.u32(2);
  for (int i = 0; i < 2; ++i) {
    const recording::records::ImageObject object = image_object(i);
    expected.time(1'700'000'001, 270'000'000).text("sensor_car").u32(1);
    expected.text(i == 0 ? "confirmed" : "tentative").f64(1);
    put_pose(expected, object.x, object.y, object.heading);
    const double xy = object.correlation_xy * object.sigma_x * object.sigma_y;
    for (int row = 0; row < 6; ++row)
      for (int column = 0; column < 6; ++column) {
        double value = 0;
        if (row == 0 && column == 0) value = object.sigma_x * object.sigma_x;
        if (row == 1 && column == 1) value = object.sigma_y * object.sigma_y;
        if (row + column == 1) value = xy;
        if (row == 5 && column == 5) value = object.sigma_heading * object.sigma_heading;
        expected.f64(value);
      }
    put_pose(expected, object.x, object.y, object.heading);
    expected.f64(object.length).f64(object.width).f64(0).text(i == 0 ? "100" : "101");
  }
  expect_bytes(stranger.next(), expected);
}

TEST(RosWire, TracksHaveTheBytesOfTheirMessage) {
  const RosOptions options = options_of_its_own();
  RosPublisher publisher(options);
  Stranger stranger;
  stranger.listen(ttfusion_msgs_msg_dds__TrackArray__desc, "rt/" + options.node_name + "/tracks");
  const DrawnTrack tracks[] = {{2'000'000'000, 5, 31}, {2'000'000'000, 5, 32}};
  for (const DrawnTrack& track : tracks) publisher.on(track.record);
  publisher.on(recording::records::FusionStep{stamp_at(2'000'000'000), 5, 2, 7});
  Cdr expected = header(1'700'000'002, 250'000'000);
  expected.u32(5).u16(2).u16(7).u32(2);
  for (const DrawnTrack& track : tracks) {
    expected.u16(static_cast<std::uint16_t>(track.record.track)).time(1'700'000'002, 248'000'000);
    for (const double value : track.state) expected.f64(value);
    for (const double value : track.covariance) expected.f64(value);
  }
  expect_bytes(stranger.next(), expected);
}

// nav_msgs/Odometry: header, child_frame_id, pose and its covariance, twist (linear, angular) and its covariance.
TEST(RosWire, TruthHasTheBytesOfOdometry) {
  RosOptions options = options_of_its_own();
  options.truth_objects = 2;
  RosPublisher publisher(options);
  Stranger stranger;
  stranger.listen(nav_msgs_msg_dds__Odometry__desc, "rt/" + options.node_name + "/truth/object_1");
  publisher.on(truth_at(3'000'000'000, 0));  // on its own topic
  publisher.on(truth_at(3'000'000'000, 1));
  Cdr expected = header(1'700'000'003, 250'000'000);
  expected.text("object_1");
  put_pose(expected, 12.5, -3.25, 0.5);
  for (int i = 0; i < 36; ++i) expected.f64(0);
  for (const double value : {27.5, 0.0, 0.0, 0.0, 0.0, 0.0625}) expected.f64(value);
  for (int i = 0; i < 36; ++i) expected.f64(0);
  expect_bytes(stranger.next(), expected);
}

// diagnostic_msgs/DiagnosticArray: header; status of level, name, message, hardware_id, values of (key,
// value). The last one is kept for late joiners.
TEST(RosWire, AHealthHasTheBytesOfDiagnosticsAndIsKept) {
  const RosOptions options = options_of_its_own();
  RosPublisher publisher(options);
  const HealthValue values[] = {{"late wake-ups", "3"}, {"state", "normal active"}};
  publisher.health({TrueTime{0}, HealthLevel::kOk, "fusion", "fine", {}});
  publisher.health({TrueTime{4'000'000'000}, HealthLevel::kWarn, "fusion", "late", values});
  for (int i = 0; i < 500 && publisher.counts().health.written < 2; ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds{10});
  common::Participant participant(kRosDomain, std::chrono::seconds{3});
  const dds_entity_t topic = dds_create_topic(participant.handle(), &diagnostic_msgs_msg_dds__DiagnosticArray__desc,
                                              "rt/diagnostics", nullptr, nullptr);
  dds_qos_t* qos = dds_create_qos();
  dds_qset_reliability(qos, DDS_RELIABILITY_RELIABLE, DDS_INFINITY);
  dds_qset_durability(qos, DDS_DURABILITY_TRANSIENT_LOCAL);
  dds_qset_history(qos, DDS_HISTORY_KEEP_LAST, 10);
  const dds_entity_t reader = dds_create_reader(participant.handle(), topic, qos, nullptr);
  dds_delete_qos(qos);
  Cdr expected = header(1'700'000'004, 250'000'000);
  expected.u32(1).u8(1).text("fusion").text("late").text(options.node_name).u32(2);
  expected.text("late wake-ups").text("3").text("state").text("normal active");
  bool seen = false;
  for (int i = 0; i < 500 && !seen; ++i, std::this_thread::sleep_for(std::chrono::milliseconds{10})) {
    ddsi_serdata* sample = nullptr;
    dds_sample_info_t info;
    while (dds_takecdr(reader, &sample, 1, &info, DDS_ANY_STATE) == 1) {
      std::vector<std::uint8_t> bytes(ddsi_serdata_size(sample));
      ddsi_serdata_to_ser(sample, 0, bytes.size(), bytes.data());
      ddsi_serdata_unref(sample);
      bytes.erase(bytes.begin(), bytes.begin() + 4);
      const std::string text(bytes.begin(), bytes.end());
      if (text.find(options.node_name) == std::string::npos) continue;  // somebody else's
      EXPECT_EQ(text.find("fine"), std::string::npos) << "of a volatile writer's past the newest only is kept";
      expect_bytes(bytes, expected);
      seen = true;
    }
  }
  EXPECT_TRUE(seen);
}

TEST(RosWire, NamesTypesAndQualitiesAreAsRosExpectsThem) {
  RosOptions options = options_of_its_own();
  options.image_period = Duration::milliseconds(20);
  options.step_period = Duration::milliseconds(40);
  options.truth_period = Duration::milliseconds(60);
  options.truth_objects = 2;
  options.liveliness_lease = std::chrono::milliseconds{700};
  RosPublisher publisher(options);
  const Stranger stranger;
  const auto found = stranger.publications(options.node_name + "/", 5);
  const std::string prefix = "rt/" + options.node_name + "/";
  struct Expected {
    std::string topic, type;
    std::int64_t deadline_ms;
  };
  const Expected all[] = {{"image", "ttfusion_msgs::msg::dds_::RealTimeImage_", 30},
                          {"image/boxes", "vision_msgs::msg::dds_::Detection3DArray_", 30},
                          {"tracks", "ttfusion_msgs::msg::dds_::TrackArray_", 60},
                          {"truth/object_0", "nav_msgs::msg::dds_::Odometry_", 90},
                          {"truth/object_1", "nav_msgs::msg::dds_::Odometry_", 90}};
  ASSERT_EQ(found.size(), std::size(all));
  for (const Expected& expected : all) {
    SCOPED_TRACE(expected.topic);
    const auto it = found.find(prefix + expected.topic);
    ASSERT_NE(it, found.end());
    EXPECT_EQ(it->second.type, expected.type);
    const dds_qos_t* qos = it->second.qos.get();
    dds_duration_t duration = 0;
    ASSERT_TRUE(dds_qget_deadline(qos, &duration));
    EXPECT_EQ(duration, DDS_MSECS(expected.deadline_ms));
    dds_liveliness_kind_t liveliness = DDS_LIVELINESS_MANUAL_BY_TOPIC;
    ASSERT_TRUE(dds_qget_liveliness(qos, &liveliness, &duration));
    EXPECT_EQ(liveliness, DDS_LIVELINESS_AUTOMATIC);
    EXPECT_EQ(duration, DDS_MSECS(700));
    dds_reliability_kind_t reliability = DDS_RELIABILITY_BEST_EFFORT;
    ASSERT_TRUE(dds_qget_reliability(qos, &reliability, &duration));
    EXPECT_EQ(reliability, DDS_RELIABILITY_RELIABLE);
    dds_durability_kind_t durability = DDS_DURABILITY_PERSISTENT;
    ASSERT_TRUE(dds_qget_durability(qos, &durability));
    EXPECT_EQ(durability, DDS_DURABILITY_VOLATILE);
    std::uint32_t representations = 0;
    dds_data_representation_id_t* which = nullptr;
    ASSERT_TRUE(dds_qget_data_representation(qos, &representations, &which));
    EXPECT_EQ(representations, 1u);
    EXPECT_EQ(which[0], DDS_DATA_REPRESENTATION_XCDR1);
    dds_free(which);
  }
}

TEST(RosTime, CountsNanosecondsOnFromTheSecondBefore) {
  const auto is = [](std::int64_t ns, std::int32_t sec, std::uint32_t nanosec) {
    const auto time = ros_time(ns);
    return time.sec == sec && time.nanosec == nanosec;
  };
  EXPECT_TRUE(is(0, 0, 0));
  EXPECT_TRUE(is(1'700'000'000, 1, 700'000'000));
  EXPECT_TRUE(is(-1'700'000'000, -2, 300'000'000));  // the example of builtin_interfaces/msg/Time.msg
  EXPECT_TRUE(is(-2'000'000'000, -2, 0));
  EXPECT_TRUE(is(std::numeric_limits<std::int64_t>::max(), std::numeric_limits<std::int32_t>::max(), 999'999'999));
  EXPECT_TRUE(is(std::numeric_limits<std::int64_t>::min(), std::numeric_limits<std::int32_t>::min(), 0));
}

}  // namespace
}  // namespace ttf::bus::dds::ros
