#include "nodes/sensing/mono_camera.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "nodes/sensing/observation_codec.h"
#include "schedules/file/loader.h"

namespace ttf::nodes::sensing {
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

// The camera's device and host, hand in hand.
class LaneCamera : public testing::Test {
 protected:
  static sim::world::MonoCameraConfig sure() {
    sim::world::MonoCameraConfig config;
    config.detection_probability = 1.0;
    config.clutter_per_frame = 0.0;
    config.marks.miss_probability = config.marks.false_per_list = 0.0;
    return config;
  }

  static std::vector<host::Output> outputs_of(const Cluster& cluster, const schedules::model::Task& task) {
    std::vector<host::Output> outputs;
    for (const auto& binding : task.writes) outputs.emplace_back(binding.port, binding.pdu, cluster.pdu(binding.pdu));
    return outputs;
  }
  const host::Output& output(const std::string& port) const {
    for (const host::Output& one : listed_)
      if (one.port() == port) return one;
    throw std::runtime_error(port);
  }

  // Measures and preprocesses this list; `marks_lost` leaves the list of marks of the last time.
  void run(std::uint32_t sequence, bool marks_lost = false) {
    const Cluster& cluster = cluster_;
    host::StepContext measuring;
    measuring.measurement = sequence;
    measuring.outputs = sent_;
    measuring.sink = &nobody_;
    device_.run(measuring);
    std::vector<host::StrobeLatch> strobes(cluster.sensors.size());
    strobes[index_of(camera_)].strobe(sequence, GlobalTime{1'000'000});
    std::vector<host::Input> inputs;
    for (const auto& binding : host_task_.reads)
      for (const host::Output& one : sent_)
        if (one.port() == binding.port)
          inputs.push_back({binding.port, binding.pdu, &cluster.pdu(binding.pdu), one.view(),
                            !(marks_lost && binding.port == "marks")});
    host::StepContext reading;
    reading.inputs = inputs;
    reading.outputs = listed_;
    reading.strobes = strobes;
    reading.sink = &nobody_;
    host_.run(reading);
  }
  double lane(int index, const char* signal) const {
    const host::Output& lanes = output("lanes");
    const auto found = schedules::model::find_signal(lanes.layout().element, signal);
    return host::element_value(lanes.layout(), lanes.view(), index, *found);
  }

  Cluster cluster_ = schedules::file::load_cluster(TTF_SOURCE_DIR "/schedules/surround_synchronised.yaml");
  SensorId camera_ = *cluster_.find_sensor("mono_camera");
  const schedules::model::Task& task_ = cluster_.node(cluster_.sensor(camera_).device).tasks.front();
  const schedules::model::Task& host_task_ = cluster_.node(cluster_.sensor(camera_).host).tasks.front();
  MonoCameraEmulator device_{{&cluster_, &task_, camera_, std::make_shared<Lane>(), 1, 0}, sure()};
  MonoCameraPreprocessing host_{cluster_, host_task_, {}};
  std::vector<host::Output> sent_ = outputs_of(cluster_, task_), listed_ = outputs_of(cluster_, host_task_);
  recording::records::Sink nobody_;
};

TEST_F(LaneCamera, ListsTheCarAndBothMarks) {
  int cars = 0;
  for (std::uint32_t list = 1; list <= 6; ++list) {
    run(list);
    std::vector<ttf::fusion::sensors::Observation> seen;
    const host::Output& objects = output("objects");
    ObservationCodec(cluster_, objects.pdu()).decode(objects.view(), seen);
    for (const auto& one : seen)
      if (std::abs(one.z.x() - 22.8) < 2.5 && std::abs(one.z.y()) < 0.5) ++cars;
    ASSERT_EQ(host::element_count(output("lanes").layout(), output("lanes").view()), 2);
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

TEST_F(LaneCamera, MarksOfAnotherPictureAreLeftOut) {
  run(1);
  run(2, true);
  EXPECT_EQ(host::element_count(output("lanes").layout(), output("lanes").view()), 0);
  EXPECT_TRUE(output("objects").written());
}

TEST(LaneCameraFile, TheBoxesComeFirst) {
  Cluster cluster = schedules::file::load_cluster(TTF_SOURCE_DIR "/schedules/surround_synchronised.yaml");
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
}  // namespace ttf::nodes::sensing
