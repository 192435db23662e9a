#include "sensors/mono_camera/emulator.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "sensors/mono_camera/preprocessing.h"
#include "sensors/observation_codec.h"
#include "tests/schedules/cluster_file.h"

namespace ttf::sensors::mono_camera {
namespace {

using schedules::model::Cluster;

// A car ahead on a lane.
class Lane final : public Scene {
 public:
  void states_at(TrueTime, std::vector<sim::world::ObjectState>& out) const override {
    out.resize(1);
    out[0] = {};
    out[0].x = 25.0;
    out[0].length = 4.4;
    out[0].width = 1.8;
  }
  std::size_t objects() const override { return 1; }
  const sim::world::road::Road* road() const override { return &road_; }
  sim::world::EgoState ego_at(TrueTime) const override { return {.x = 50.0, .y = -1.75}; }

 private:
  sim::world::road::Road road_{{.pieces = {{.length = 200.0}}, .left = 0, .right = 1}};
};

// `surround` with lists of lane marks beside those of boxes.
Cluster with_lanes() {
  std::string text = schedules::shipped_text("surround_synchronised");
  const auto put = [&](const std::string& before, const std::string& after) {
    const std::size_t at = text.find(before);
    if (at == std::string::npos) throw std::runtime_error(before);
    text.replace(at, before.size(), after);
  };
  const std::string mark =
      "    element: [{name: offset, unit: m, bits: 16, low: -32.768, resolution: 0.001},\n"
      "      {name: heading, unit: rad, bits: 16, low: -1.6384, resolution: 0.00005},\n"
      "      {name: curvature, unit: 1/m, bits: 16, low: -0.32768, resolution: 0.00001}";
  put("mono_camera_emulator", "lane_camera_emulator");
  put("mono_camera_preprocessing", "lane_camera_preprocessing");
  put("writes: {raw: mono_boxes on mono_can}", "writes: {marks: mono_marks on mono_can, raw: mono_boxes on mono_can}");
  put("reads: {raw: mono_boxes on mono_can}", "reads: {raw: mono_boxes on mono_can, marks: mono_marks on mono_can}");
  put("writes: {objects: mono_objects on flexray}",
      "writes: {objects: mono_objects on flexray, lanes: mono_lanes on flexray}");
  put("messages: [{pdu: mono_boxes",
      "messages: [{pdu: mono_marks, identifier: 304, sender: mono_camera, shortest_period: 39 ms}, {pdu: mono_boxes");
  put("  stereo_frame:\n",
      "  mono_marks:\n    fragment_bytes: 64\n    max_elements: 8\n    elements_per_fragment: 8\n"
      "    header: *scan_header\n" +
          mark + "]\n  stereo_frame:\n");
  put("  stereo_objects:\n",
      "  mono_lanes:\n    fragment_bytes: 56\n    max_elements: 4\n    elements_per_fragment: 4\n"
      "    header: *list_header\n" +
          mark +
          ",\n      {name: sigma_offset, unit: m, bits: 10, resolution: 0.005},\n"
          "      {name: sigma_heading, unit: rad, bits: 10, resolution: 0.0005},\n"
          "      {name: sigma_curvature, unit: 1/m, bits: 10, resolution: 0.00005},\n"
          "      {name: validity, bits: 8, resolution: 0.01}]\n  stereo_objects:\n");
  return schedules::file::parse_cluster(std::move(text), "lanes.yaml");
}

// The camera's device and host, hand in hand.
class LaneCamera : public testing::Test {
 protected:
  static MonoCameraConfig sure() {
    MonoCameraConfig config;
    config.detection_probability = 1.0;
    config.clutter_per_frame = 0.0;
    config.marks.miss_probability = config.marks.false_per_list = 0.0;
    return config;
  }

  static std::vector<nodes::host::Output> outputs_of(const Cluster& cluster, const schedules::model::Task& task) {
    std::vector<nodes::host::Output> outputs;
    for (const auto& binding : task.writes) outputs.emplace_back(binding.port, binding.pdu, cluster.pdu(binding.pdu));
    return outputs;
  }
  const nodes::host::Output& output(const std::string& port) const {
    for (const nodes::host::Output& one : listed_)
      if (one.port() == port) return one;
    throw std::runtime_error(port);
  }

  // Measures and preprocesses this list; `marks_lost` leaves the list of marks of the last time.
  void run(std::uint32_t sequence, bool marks_lost = false) {
    measure(sequence);
    preprocess(sequence, marks_lost);
  }
  void measure(std::uint32_t sequence) {
    nodes::host::StepContext measuring;
    measuring.measurement = sequence;
    measuring.outputs = sent_;
    measuring.sink = &nobody_;
    device_.run(measuring);
  }
  void preprocess(std::uint32_t sequence, bool marks_lost = false) {
    const Cluster& cluster = cluster_;
    std::vector<nodes::host::StrobeLatch> strobes(cluster.sensors.size());
    strobes[index_of(camera_)].strobe(sequence, GlobalTime{1'000'000});
    std::vector<nodes::host::Input> inputs;
    for (const auto& binding : host_task_.reads)
      for (const nodes::host::Output& one : sent_)
        if (one.port() == binding.port)
          inputs.push_back({binding.port, binding.pdu, &cluster.pdu(binding.pdu), one.view(),
                            !(marks_lost && binding.port == "marks")});
    nodes::host::StepContext reading;
    reading.inputs = inputs;
    reading.outputs = listed_;
    reading.strobes = strobes;
    reading.sink = &nobody_;
    host_.run(reading);
  }
  double lane(int index, const char* signal) const {
    const nodes::host::Output& lanes = output("lanes");
    const auto found = schedules::model::find_signal(lanes.layout().element, signal);
    return nodes::host::element_value(lanes.layout(), lanes.view(), index, *found);
  }

  Cluster cluster_ = with_lanes();
  SensorId camera_ = *cluster_.find_sensor("mono_camera");
  const schedules::model::Task& task_ = cluster_.node(cluster_.sensor(camera_).device).tasks.front();
  const schedules::model::Task& host_task_ = cluster_.node(cluster_.sensor(camera_).host).tasks.front();
  MonoCameraEmulator device_{{&cluster_, &task_, camera_, std::make_shared<Lane>(), 1, 0}, sure()};
  MonoCameraPreprocessing host_{cluster_, host_task_, {}};
  std::vector<nodes::host::Output> sent_ = outputs_of(cluster_, task_), listed_ = outputs_of(cluster_, host_task_);
  recording::records::Sink nobody_;
};

TEST_F(LaneCamera, ListsTheCarAndBothMarks) {
  int cars = 0;
  for (std::uint32_t list = 1; list <= 6; ++list) {
    run(list);
    std::vector<ttf::fusion::sensors::Observation> seen;
    const nodes::host::Output& objects = output("objects");
    ObservationCodec(cluster_, objects.pdu()).decode(objects.view(), seen);
    for (const auto& one : seen)
      if (std::abs(one.z.x() - 22.8) < 2.5 && std::abs(one.z.y()) < 0.5) ++cars;
    ASSERT_EQ(nodes::host::element_count(output("lanes").layout(), output("lanes").view()), 2);
    for (int side = 0; side < 2; ++side) {
      EXPECT_NEAR(lane(side, "offset"), side == 0 ? -1.75 : 1.75, 0.25);
      EXPECT_NEAR(lane(side, "heading"), 0.0, 0.025);
      EXPECT_NEAR(lane(side, "curvature"), 0.0, 0.0025);
      EXPECT_NEAR(lane(side, "sigma_offset"), 0.05, 0.005);
      EXPECT_NEAR(lane(side, "validity"), list < 5 ? 0.2 * list : 1.0, 0.006);
    }
  }
  EXPECT_GE(cars, 5);
}

// Also one that is of no class.
TEST_F(LaneCamera, AnObjectsClassIsThatOfItsBox) {
  nodes::host::Output& raw =
      *std::find_if(sent_.begin(), sent_.end(), [](const nodes::host::Output& one) { return one.port() == "raw"; });
  for (std::uint32_t code = 0; code < 8; ++code) {
    measure(code);
    ASSERT_EQ(nodes::host::element_count(raw.layout(), raw.view()), 1);
    raw.set(0, *schedules::model::find_signal(raw.layout().element, "class"), code);
    preprocess(code);
    const nodes::host::Output& objects = output("objects");
    ASSERT_EQ(nodes::host::element_count(objects.layout(), objects.view()), 1);
    const auto signal = schedules::model::find_signal(objects.layout().element, "class");
    EXPECT_EQ(nodes::host::element_value(objects.layout(), objects.view(), 0, *signal), code);
  }
}

TEST_F(LaneCamera, MarksOfAnotherPictureAreLeftOut) {
  run(1);
  run(2, true);
  EXPECT_EQ(nodes::host::element_count(output("lanes").layout(), output("lanes").view()), 0);
  EXPECT_TRUE(output("objects").written());
}

TEST(LaneCameraFile, TheBoxesComeFirst) {
  Cluster cluster = with_lanes();
  schedules::model::Task task = cluster.node(cluster.sensor(*cluster.find_sensor("mono_camera")).host).tasks.front();
  std::swap(task.reads[0], task.reads[1]);
  try {
    const MonoCameraPreprocessing host(cluster, task, {});
    FAIL() << "the marks have no strobe";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("reads.marks = mono_marks: must follow raw"));
  }
}

}  // namespace
}  // namespace ttf::sensors::mono_camera
