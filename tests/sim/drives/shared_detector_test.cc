// Cameras that share a detector: the same every time, without allocations, within the schedule's ages, and distinguished
// from others.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>
#include <string>
#include <vector>

#include "core/file_bytes.h"
#include "schedules/analysis/ages.h"
#include "sim/drives/detectors.h"
#include "tests/sim/drives/drive_fixture.h"
#include "tests/support/allocation_counter.h"
#include "tests/support/refusals.h"

namespace ttf::sim::drives {
namespace {

using fusion::strategies::StrategyKind;
using testing::HasSubstr;

constexpr const char* kShared = "scenarios/shared_detector.yaml";

struct Detections final : recording::records::Sink {
  std::vector<std::string> frames;
  std::vector<std::int64_t> values;  // all detections'
  std::vector<Duration> ages;        // camera_a's lists, where they are fused
  std::uint64_t secondaries = 0;
  std::int64_t allocations_at_start = -1, allocations = 0;
  Detections() {
    frames.reserve(100);
    values.reserve(10'000);
    ages.reserve(1'000);
  }
  using Sink::on;
  void on(const recording::records::SequencePlanned& r) override { frames.emplace_back(r.text); }
  void on(const recording::records::DetectionMade& r) override {
    values.insert(values.end(), {r.stamp.true_time.ns, r.begin.ns, r.took.ns, r.id.sequence, r.found});
    secondaries += r.secondary ? 1 : 0;
  }
  void on(const recording::records::FusionInput& r) override {
    if (r.sensor == SensorId{0}) ages.push_back(r.stamp.global - r.measured);
  }
  void on(const recording::records::TaskRun&) override {
    allocations = support::allocations();
    if (allocations_at_start < 0) allocations_at_start = allocations;
  }
};

TEST(SharedDetector, RepeatsItselfAllocatesNothingAndKeepsTheSchedulesAges) {
  for (const StrategyKind kind : {StrategyKind::kAdva, StrategyKind::kTt}) {
    Drive drive(kShared, kind);
    drive.scenario.duration = Duration::milliseconds(2'000);
    Detections once, again, otherwise;
    drive.run(once);
    drive.run(again);
    drive.run(otherwise, 2);
    ASSERT_GT(once.values.size(), 5 * 40u) << name_of(kind);
    EXPECT_EQ(once.values, again.values);
    EXPECT_NE(once.values, otherwise.values);
    EXPECT_EQ(once.allocations, once.allocations_at_start);
    EXPECT_GT(once.secondaries, 15u);
    EXPECT_GT(std::ranges::count(once.frames, "AaBaCa"), 3);
    const auto ages = schedules::analysis::measurement_ages(drive.cluster);
    EXPECT_TRUE(ages.at(0).chosen);
    for (const Duration age : once.ages) {
      EXPECT_GE(age, ages[0].fused_best);
      EXPECT_LE(age, ages[0].fused_worst);
    }
    // 70 ms hold it at most; most detections take 50 or 30.
    EXPECT_GT(ages[0].fused_worst, Duration::milliseconds(75));
  }
}

std::string refusal(const std::string& key, const std::string& changed, const std::string& scenario = {}) {
  std::string text = read_file(shipped("schedules/adaptive_synchronised.yaml"));
  const std::size_t at = text.find(key);
  if (at == std::string::npos) return "no " + key;
  text.replace(at, key.size(), changed);
  return support::refusal_of(
      [&] {
        const schedules::model::Cluster cluster = schedules::file::parse_cluster(text, "cluster.yaml");
        check_steps(cluster);
        const std::string file = shipped(kShared);
        check_tasks(parse_scenario(read_file(file) + scenario, "shared.yaml"), cluster);
      },
      "taken");
}

TEST(SharedDetector, RefusesWhatItCannotLookAt) {
  EXPECT_EQ(refusal("holds: 70 ms", "holds: 50 ms"), "taken");
  for (const std::string held : {"49 ms", "20 ms"})
    EXPECT_THAT(refusal("holds: 70 ms", "holds: " + held),
                HasSubstr("nodes.detector.tasks.detect.holds = " + held +
                          ": must be at least 50 ms, in steps of 10 ms: a whole picture takes 46.3 ms by "
                          "adaptive_camera.picture_time and hardware_factor of shared.yaml"));
  EXPECT_THAT(refusal("holds: 70 ms", "holds: 19 ms"),
              HasSubstr("nodes.detector.tasks.detect.holds = 19 ms: must be at least 20 ms"));
  EXPECT_THAT(refusal("deadline: 3500 us,", "deadline: 3500 us, holds: 20 ms,"),
              HasSubstr("nodes.fusion.tasks.fuse.holds = 20 ms: must be absent"));
  EXPECT_THAT(refusal(", camera_b_objects: camera_b_objects on flexray", ""),
              HasSubstr("reads.camera_b = camera_b_boxes: needs a port camera_b_objects among writes"));
  EXPECT_THAT(refusal("camera_b: camera_b_boxes on camera_can,", ""),
              HasSubstr("writes.camera_b_objects = camera_b_objects: must be absent"));
  EXPECT_THAT(refusal("kind: mono_camera, device: camera_c", "kind: camera, device: camera_c"),
              HasSubstr("reads.camera_c = camera_c_boxes: must be a list of a mono_camera"));
  const std::string reads =
      "reads: {camera_a: camera_a_boxes on camera_can, camera_b: camera_b_boxes on camera_can,\n"
      "                camera_c: camera_c_boxes on camera_can}";
  EXPECT_THAT(refusal(reads, "reads: {}"), HasSubstr("nodes.detector.tasks.detect.reads: must bind at least one"));
  EXPECT_THAT(refusal(reads, "reads: {regions: image on flexray}"),
              HasSubstr("nodes.detector.tasks.detect.reads: must have a list of a camera"));
  EXPECT_THAT(refusal("reads: {camera_a: camera_a", "reads: {regions: image on flexray, camera_a: camera_a"),
              HasSubstr("adaptive_camera.regions: must be absent: in cluster.yaml the detector reads"));
}

TEST(SharedDetector, RegionsAreOfItsCameras) {
  const std::string text = read_file(shipped(kShared)), region = "{camera: camera_a,";
  const auto refused = [&](const std::string& changed) -> std::string {
    std::string other = text;
    other.replace(other.find(region), region.size(), changed);
    return support::refusal_of(
        [&] { check_tasks(parse_scenario(other, "shared.yaml"), Drive(kShared, StrategyKind::kTt).cluster); }, "taken");
  };
  EXPECT_EQ(refused("{camera: camera_b,"), "taken");
  EXPECT_THAT(refused("{camera: camera_d,"),
              HasSubstr("adaptive_camera.regions[0].camera = camera_d: must be a camera of"));
  EXPECT_THAT(refused("{"), HasSubstr("adaptive_camera.regions[0].camera"));
  // The picture reaches 360 px from its middle.
  const std::size_t at = text.find(region) + region.size(), end = text.find('}', at);
  const auto shown = [&](const std::string& place) {
    std::string other = text;
    other.replace(at, end - at, place);
    try {
      check_tasks(parse_scenario(other, "shared.yaml"), Drive(kShared, StrategyKind::kTt).cluster);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("taken");
  };
  EXPECT_EQ(shown(" x: -400, y: 300, width: 5100, height: 100"), "taken");
  EXPECT_THAT(shown(" x: 400, y: -180, width: 5100, height: 360"),
              HasSubstr("adaptive_camera.regions[0].x = 400 px: must be from -5459.9 to 359.896 px: the picture of "
                        "camera_a reaches 359.896 px from its middle"));
  EXPECT_THAT(shown(" x: -180, y: -470, width: 360, height: 100"),
              HasSubstr("adaptive_camera.regions[0].y = -470 px: must be from -460 to 360 px"));
}

schedules::model::Task& detector_of(schedules::model::Cluster& cluster) {
  for (schedules::model::Node& node : cluster.nodes)
    for (schedules::model::Task& task : node.tasks)
      if (has_role(task, StepRole::kDetector)) return task;
  throw std::logic_error("no detector");
}

TEST(SharedDetector, IsTheOnlyOne) {
  schedules::model::Cluster cluster = Drive(kShared, StrategyKind::kTt).cluster;
  schedules::model::Task again = detector_of(cluster);
  again.name = "again";
  cluster.nodes.back().tasks.push_back(again);
  Findings findings;
  check_detectors(cluster, findings);
  try {
    findings.throw_if_any();
    FAIL() << "taken";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("tasks.again.step = adaptive_camera: must be another step: "
                                        "nodes.detector.tasks.detect is the detector already"));
  }
}

TEST(SharedDetector, RegionsOfOtherCamerasAreOfNoUse) {
  schedules::model::Cluster cluster = Drive(kShared, StrategyKind::kTt).cluster;
  schedules::model::Task& task = detector_of(cluster);
  const std::vector<SensorId> cameras = cameras_of(cluster, task);
  for (const SensorId camera : cameras) EXPECT_TRUE(looks_at_regions(cluster, camera));
  task.reads.erase(task.reads.begin());
  for (const SensorId camera : cameras) EXPECT_EQ(looks_at_regions(cluster, camera), camera != cameras.front());
  task.step = "fusion";
  EXPECT_TRUE(looks_at_regions(cluster, cameras.front())) << "nobody chooses";
}

}  // namespace
}  // namespace ttf::sim::drives
