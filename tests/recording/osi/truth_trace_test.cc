// Traces as they should be, as other tools write them, and as they must not be.
#include "recording/osi/truth_trace.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <functional>
#include <limits>

#include "core/errors.h"
#include "core/file_bytes.h"
#include "tests/recording/osi/written_trace.h"

namespace ttf::recording::osi {
namespace {

using testing::HasSubstr;

// The sentence of a refusal; empty if the trace is read.
std::string refusal(const std::string& bytes) {
  try {
    parse_truth_trace(bytes, "a.osi");
  } catch (const InputError& error) {
    EXPECT_EQ(error.findings().size(), 1u);
    return error.what();
  }
  return "";
}
// The same for three messages of which the last is changed.
std::string refusal(const std::function<void(osi3::GroundTruth&)>& change) {
  std::vector<osi3::GroundTruth> truths = steady(3);
  change(truths.back());
  return refusal(framed(truths));
}

std::vector<osi3::SensorView> views_of(const std::vector<osi3::GroundTruth>& truths) {
  std::vector<osi3::SensorView> views;
  for (const osi3::GroundTruth& truth : truths) {
    osi3::SensorView& view = views.emplace_back();
    *view.mutable_timestamp() = truth.timestamp();
    view.mutable_sensor_id()->set_value(7);
    *view.mutable_global_ground_truth() = truth;
  }
  return views;
}

std::string mcap_of(const std::vector<std::pair<std::string, std::string>>& channels) {
  const std::string path = (std::filesystem::temp_directory_path() / "ttfusion_truth_trace_test.mcap").string();
  mcap::McapWriter writer(path, "", "another tool");
  std::uint16_t id = 0;
  for (const auto& [schema, message] : channels) {
    ++id;
    writer.add_schema(id, schema, "protobuf", "");
    writer.add_channel(id, id, "topic" + std::to_string(id), "protobuf");
  }
  id = 0;
  for (const auto& [schema, message] : channels) writer.add_message(++id, 0, 0, message);
  writer.close();
  const std::string bytes = read_file(path);
  std::filesystem::remove(path);
  return bytes;
}

TEST(Encoding, IsThatOfThePublishedVectors) {
  const auto hex = [](const google::protobuf::Message& message) {
    std::string text;
    for (const char c : message.SerializeAsString()) text += fmt::format("{:02x} ", static_cast<unsigned char>(c));
    return text;
  };
  osi3::Timestamp stamp;
  stamp.set_seconds(1);
  stamp.set_nanos(500'000'000);
  EXPECT_EQ(hex(stamp), "08 01 10 80 ca b5 ee 01 ");
  osi3::Identifier id;
  id.set_value(42);
  EXPECT_EQ(hex(id), "08 2a ");
  osi3::Vector3d x;
  x.set_x(1.0);
  EXPECT_EQ(hex(x), "09 00 00 00 00 00 00 f0 3f ");
}

// The thousand SensorViews of OSI's documentation; their nanoseconds go up to a second.
TEST(TruthTrace, ReadsTheDocumentationsExample) {
  std::vector<osi3::GroundTruth> truths;
  std::int64_t ns = 0;
  for (int k = 1; k <= 1000; ++k) {
    ns += 10'000'000;
    const bool whole = ns % 1'000'000'000 == 0;  // 1000000000 ns, and not the next second
    truths.push_back(truth_at(ns / 1'000'000'000 - (whole ? 1 : 0),
                              static_cast<std::uint32_t>(whole ? 1'000'000'000 : ns % 1'000'000'000)));
    add_object(truths.back(), 42, 0.5 * k, 0.0);
  }
  const TruthTrace trace = parse_truth_trace(framed(views_of(truths)), "a.osi");
  EXPECT_EQ(trace.type, "SensorView");
  EXPECT_TRUE(trace.guessed);
  EXPECT_EQ(trace.length(), Duration::milliseconds(9990));
  ASSERT_EQ(trace.objects.size(), 1u);
  const TracedObject& object = trace.objects[0];
  EXPECT_EQ(object.id, 42u);
  EXPECT_EQ(object.length, 5.0);
  EXPECT_EQ(object.width, 2.0);
  ASSERT_EQ(object.lives.size(), 1u);
  EXPECT_EQ(object.lives[0].states.back().x, 500.0);
  for (const TracedState& state : object.lives[0].states) {
    ASSERT_NEAR(state.vx, 50.0, 1e-9) << "without a velocity it is the positions' difference";
    ASSERT_NEAR(state.ax, 0.0, 1e-9);
  }
}

TEST(TruthTrace, DistinguishesGroundTruthFromSensorView) {
  const TruthTrace trace = parse_truth_trace(framed(steady(3)), "a.osi");
  EXPECT_EQ(trace.type, "GroundTruth");
  EXPECT_FALSE(trace.host);
  osi3::SensorData data;
  data.mutable_timestamp()->set_seconds(1);
  data.add_moving_object()->mutable_header()->mutable_tracking_id()->set_value(3);
  EXPECT_THAT(refusal(framed<osi3::SensorData>({data})), HasSubstr("is one of SensorData"));
  EXPECT_THAT(refusal(framed<osi3::Timestamp>({data.timestamp()})),
              HasSubstr("must be a trace of GroundTruth or SensorView"));
}

TEST(TruthTrace, ReadsTheChannelOfAnMcapFile) {
  const std::string truth = steady(1)[0].SerializeAsString(), view = views_of(steady(1))[0].SerializeAsString();
  const TruthTrace trace = parse_truth_trace(
      mcap_of({{"ttfusion.Truth", "x"}, {"osi3.SensorView", view}, {"osi3.GroundTruth", truth}}), "a.mcap");
  EXPECT_EQ(trace.type, "GroundTruth");
  EXPECT_FALSE(trace.guessed);
  EXPECT_EQ(parse_truth_trace(mcap_of({{"osi3.SensorView", view}}), "a.mcap").type, "SensorView");
  EXPECT_THAT(refusal(mcap_of({{"ttfusion.Truth", "x"}, {"osi3.SensorData", ""}})),
              HasSubstr("must have a channel of osi3.GroundTruth or osi3.SensorView, and has channels of "
                        "ttfusion.Truth, osi3.SensorData"));
  EXPECT_THAT(refusal(mcap_of({{"osi3.GroundTruth", truth}, {"osi3.GroundTruth", truth}})),
              HasSubstr("must have one channel of osi3.GroundTruth, and has 2"));
  const std::string whole = mcap_of({{"osi3.GroundTruth", truth}});
  EXPECT_THAT(refusal(whole.substr(0, whole.size() - 30)), HasSubstr("was cut off at byte"));
  EXPECT_THAT(refusal(mcap_of({{"osi3.GroundTruth", "x"}})), HasSubstr("message 1: must be a GroundTruth, and cannot"));
}

TEST(TruthTrace, RefusesWhatIsNoTrace) {
  EXPECT_EQ(refusal(""), "a.osi: must have a message, and is empty");
  EXPECT_THAT(refusal("name: a scenario\n"), HasSubstr("it is no OSI trace, or was cut off at byte 17"));
  const std::string whole = framed(steady(3));
  const std::size_t two = framed(steady(2)).size();
  EXPECT_EQ(
      refusal(whole.substr(0, whole.size() - 1)),
      fmt::format("a.osi: was cut off within message 3 at byte {0}: a trace must be whole, and `head -c {0}` leaves "
                  "the 2 before it",
                  two));
  EXPECT_EQ(refusal(whole.substr(0, two)), "");
}

TEST(TruthTrace, RefusesWorldsThatCannotBe) {
  EXPECT_EQ(refusal([](auto& t) { t.mutable_timestamp()->set_nanos(10'000'000); }),
            "a.osi: message 3 (0.01 s): must be later than the message before it, which is of 0.01 s");
  EXPECT_EQ(refusal([](auto& t) { t.clear_timestamp(); }), "a.osi: message 3: must have a timestamp");
  EXPECT_THAT(refusal([](auto& t) { t.mutable_timestamp()->set_seconds(5'000'000'000); }),
              HasSubstr("and has 5000000000 s"));
  EXPECT_EQ(refusal([](auto& t) { t.mutable_moving_object(0)->mutable_base()->mutable_dimension()->set_length(6.0); }),
            "a.osi: message 3 (0.02 s): object 42 must keep its size of 5 m x 2 m, and has 6 m x 2 m");
  EXPECT_THAT(refusal([](auto& t) { t.mutable_moving_object(0)->mutable_base()->clear_dimension(); }),
              HasSubstr("object 42 must have a length and a width"));
  EXPECT_THAT(refusal([](auto& t) { t.mutable_moving_object(0)->mutable_base()->clear_position(); }),
              HasSubstr("object 42 must have a position and an orientation"));
  EXPECT_THAT(
      refusal([](auto& t) {
        t.mutable_moving_object(0)->mutable_base()->mutable_position()->set_x(std::numeric_limits<double>::quiet_NaN());
      }),
      HasSubstr("object 42 must have a position of at most 1e+08 m, and has nan"));
  EXPECT_THAT(refusal([](auto& t) { t.mutable_moving_object(0)->clear_id(); }),
              HasSubstr("must give each moving object an id"));
  EXPECT_THAT(refusal([](auto& t) { add_object(t, 42, 0, 0); }), HasSubstr("has two objects with the id 42"));
  EXPECT_THAT(refusal([](auto& t) { t.mutable_host_vehicle_id()->set_value(42); }),
              HasSubstr("must name the same host vehicle as the first message"));
}

TEST(TruthTrace, AnObjectMayComeAndGo) {
  std::vector<osi3::GroundTruth> truths = steady(6);
  add_object(truths[1], 7, 1, 1);
  add_object(truths[2], 7, 2, 1);
  add_object(truths[4], 7, 9, 1).mutable_base()->mutable_velocity()->set_x(3.0);
  const TruthTrace trace = parse_truth_trace(framed(truths), "a.osi");
  ASSERT_EQ(trace.objects.size(), 2u);
  EXPECT_EQ(trace.objects[0].id, 42u);
  const TracedObject& object = trace.objects[1];
  ASSERT_EQ(object.lives.size(), 2u);
  EXPECT_EQ(object.lives[0].first, 1u);
  EXPECT_EQ(object.lives[0].states.size(), 2u);
  EXPECT_NEAR(object.lives[0].states[1].vx, 100.0, 1e-9);
  EXPECT_EQ(object.lives[1].first, 4u);
  EXPECT_EQ(object.lives[1].states[0].vx, 3.0);
}

TEST(TruthTrace, DistinguishesKinds) {
  using Vehicle = osi3::MovingObject::VehicleClassification;
  std::vector<osi3::GroundTruth> truths = steady(1);
  truths[0].mutable_moving_object(0)->set_type(osi3::MovingObject::TYPE_PEDESTRIAN);
  for (const Vehicle::Type type : {Vehicle::TYPE_CAR, Vehicle::TYPE_BICYCLE}) {
    osi3::MovingObject& object = add_object(truths[0], 50u + static_cast<unsigned>(type), 10.0, 0.0);
    object.set_type(osi3::MovingObject::TYPE_VEHICLE);
    object.mutable_vehicle_classification()->set_type(type);
  }
  add_object(truths[0], 80, 20.0, 0.0);
  std::vector<std::string_view> names;
  for (const TracedObject& object : parse_truth_trace(framed(truths), "a.osi").objects)
    names.push_back(name_of(object.kind));
  EXPECT_THAT(names, testing::ElementsAre("pedestrian", "vehicle", "two-wheeler", "other"));
}

TEST(TruthTrace, TheHostVehicleIsNoObject) {
  std::vector<osi3::GroundTruth> truths = steady(3);
  for (osi3::GroundTruth& truth : truths) {
    truth.mutable_host_vehicle_id()->set_value(3);
    add_object(truth, 3, 100, 0).mutable_vehicle_attributes()->mutable_bbcenter_to_rear()->set_x(-1.4);
  }
  const TruthTrace trace = parse_truth_trace(framed(truths), "a.osi");
  EXPECT_EQ(trace.objects.size(), 1u);
  ASSERT_TRUE(trace.host);
  EXPECT_EQ(trace.host->rear_x, -1.4);
  truths[1].mutable_moving_object()->RemoveLast();
  EXPECT_EQ(refusal(framed(truths)), "a.osi: message 2 (0.01 s): must have the host vehicle, 3");
  for (osi3::GroundTruth& truth : truths) truth.mutable_host_vehicle_id()->set_value(42);
  EXPECT_THAT(refusal(framed(std::vector<osi3::GroundTruth>(1, truths[1]))),
              HasSubstr("must have a moving object beside the host vehicle"));
}

}  // namespace
}  // namespace ttf::recording::osi
