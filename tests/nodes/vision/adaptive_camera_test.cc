// The shipped detector looks at pictures by hand.
#include "nodes/vision/adaptive_camera.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "core/file_bytes.h"
#include "nodes/host/signals.h"
#include "schedules/file/loader.h"

namespace ttf::nodes::vision {
namespace {

using namespace recording::records;

constexpr GlobalTime at_ms(std::int64_t ms) { return GlobalTime{} + Duration::milliseconds(ms); }

// The shipped cluster, with a list of regions for the detector.
const schedules::model::Cluster& cluster() {
  static const schedules::model::Cluster kCluster = [] {
    std::string text = read_file(TTF_SOURCE_DIR "/schedules/adaptive_synchronised.yaml");
    const auto put = [&](const std::string& before, const std::string& more) { text.insert(text.find(before), more); };
    put("  # How fast the vehicle drives",
        "  regions:\n    {fragment_bytes: 56, max_elements: 5, elements_per_fragment: 5,\n     header: [{name: "
        "sequence, "
        "bits: 16}, {name: fragment, bits: 8}, {name: count, bits: 8}, {name: timestamp, unit: us, bits: 32}],\n"
        "     element: [{name: sensor, bits: 8}, {name: x, unit: px, bits: 13, low: -4096}, {name: y, unit: px, bits: "
        "13, "
        "low: -4096}, {name: width, unit: px, bits: 13}, {name: height, unit: px, bits: 13}, {name: valid, bits: 1}, "
        "{name: spare, bits: 3}]}\n");
    put("camera_a: camera_a_boxes on camera_can", "regions: regions on flexray, ");
    return schedules::file::parse_cluster(text, "adaptive.yaml");
  }();
  return kCluster;
}
const schedules::model::Task& task() { return cluster().node(*cluster().find_node("detector")).tasks.front(); }

AdaptiveCameraConfig sure() {
  AdaptiveCameraConfig config;
  config.deviation = 0.0;
  return config;
}
std::vector<SharedCamera> three() {
  sensors::mono_camera::MonoCalibration calibration;
  calibration.focal_px = 1109.0;
  return std::vector<SharedCamera>(3, SharedCamera{360.0, 360.0, calibration});
}

// Each camera takes a picture 2 ms before each execution, which come every 10 ms. It has two boxes: in the middle, and
// far to the right.
struct ByHand final : Sink {
  AdaptiveCamera step;
  std::vector<host::Output> lists, outputs;
  std::vector<host::Input> inputs;
  std::vector<host::StrobeLatch> strobes{cluster().sensors.size()};
  std::string sequence;             // the newest frame's
  std::vector<DetectionMade> made;  // all
  std::int64_t now_ms = 0;
  std::uint32_t pictures = 0;
  bool blind = false;  // no pictures come

  explicit ByHand(const AdaptiveCameraConfig& config = sure(), const schedules::model::Task& of = task())
      : step(cluster(), of, config, three(), {1, 0}) {
    for (const auto& read : task().reads) {
      lists.emplace_back(read.port, read.pdu, cluster().pdu(read.pdu));
      inputs.push_back({read.port, read.pdu, &cluster().pdu(read.pdu), std::nullopt, false});
    }
    for (const auto& written : task().writes)
      outputs.emplace_back(written.port, written.pdu, cluster().pdu(written.pdu));
  }
  using Sink::on;
  void on(const DetectionMade& r) override { made.push_back(r); }
  void on(const SequencePlanned& r) override { sequence = r.text; }

  void take_pictures() {
    for (std::size_t in = 0; in < inputs.size(); ++in) {
      if (inputs[in].port == "regions") continue;
      const auto signals =
          host::bind_element<5>(cluster(), lists[in].layout(), {"left", "right", "bottom", "top", "class"});
      lists[in].begin(pictures, 2, {});
      for (int box = 0; box < 2; ++box) {
        const double values[] = {box * 300.0 - 20.0, box * 300.0 + 20.0, 40.0, 0.0};
        for (std::size_t s = 0; s < 4; ++s) lists[in].set(box, signals[s], values[s]);
      }
      inputs[in].list = lists[in].view();
      inputs[in].fresh = true;
      strobes[index_of(lists[in].layout().sensor)].strobe(pictures, at_ms(now_ms - 2));
    }
    ++pictures;
  }
  void send(const std::vector<Region>& regions) {
    const std::size_t in = task().reads.front().port == "regions" ? 0 : 1;
    const RegionSignals signals = bind_regions(cluster(), lists[in].layout());
    lists[in].begin(0, static_cast<int>(regions.size()), at_ms(now_ms));
    for (int i = 0; i < static_cast<int>(regions.size()); ++i) {
      const Region& one = regions[static_cast<std::size_t>(i)];
      const double values[] = {
          static_cast<double>(index_of(one.sensor)), one.x, one.y, one.width, one.height, one.valid ? 1.0 : 0.0};
      for (std::size_t s = 0; s < 6; ++s) lists[in].set(i, signals[s], values[s]);
    }
    inputs[in].list = lists[in].view();
    inputs[in].fresh = true;
  }
  // Returns the camera whose list the execution writes, '-' for none.
  char execute(std::int64_t after_ms = 10) {
    now_ms += after_ms;
    if (!blind) take_pictures();
    host::StepContext context;
    context.stamp.global = at_ms(now_ms);
    context.stamp.local = LocalTime{now_ms * 1'000'000 + 77};
    context.inputs = inputs;
    context.outputs = outputs;
    context.strobes = strobes;
    context.sink = this;
    for (host::Output& out : outputs) out.clear();
    step.run(context);
    for (host::Input& input : inputs) input.fresh = false;
    for (std::size_t o = 0; o < outputs.size(); ++o)
      if (outputs[o].written()) return static_cast<char>('A' + o);
    return '-';
  }
  std::string executions(int count) {
    std::string text;
    for (int i = 0; i < count; ++i) text += execute();
    return text;
  }
};

Region ahead(double half = 255.0) { return {SensorId{0}, -half, -half, 2 * half, 2 * half, true}; }

TEST(AdaptiveCamera, WithoutRegionsLooksAtEachWholePictureInTurn) {
  ByHand detector;
  // 46.3 ms are five steps.
  EXPECT_EQ(detector.executions(16), "-----A----B----C");
  EXPECT_EQ(detector.sequence, "ABC");
  ASSERT_EQ(detector.made.size(), 3u);
  const DetectionMade& second = detector.made[1];
  EXPECT_EQ(second.id.sensor, SensorId{1});
  EXPECT_EQ(second.id.sequence, 5u) << "the picture of the execution that began it";
  EXPECT_EQ(second.took, Duration::microseconds(46'300));
  EXPECT_EQ(second.area, 1.0);
  EXPECT_EQ(second.place, 1);
  EXPECT_EQ(second.found, 2);
}

TEST(AdaptiveCamera, StampsWithThePicturesInstant) {
  ByHand detector;
  (void)detector.executions(6);
  const host::Output& out = detector.outputs[0];
  EXPECT_EQ(host::past_time_stamp(out.layout(), out.view(), at_ms(60), cluster().round()), at_ms(8));
  EXPECT_EQ(host::element_count(out.layout(), out.view()), 2);
}

TEST(AdaptiveCamera, LooksAtTheRegionInBetween) {
  ByHand detector;
  detector.send({ahead()});
  // A region of half the picture takes three steps. The first frame is planned by the first guess, which is longer.
  EXPECT_EQ(detector.executions(22), "-----A--A----B----C--A");
  EXPECT_EQ(detector.executions(24), "----A--A----B--A----C--A");
  EXPECT_EQ(detector.sequence, "AaBaCa");
  const DetectionMade& second = detector.made[1];
  EXPECT_TRUE(second.secondary);
  EXPECT_NEAR(second.area, 510.0 * 510.0 / (720.0 * 720.0), 1e-12);
  EXPECT_EQ(second.found, 1) << "the other box lies beside the region";
}

TEST(AdaptiveCamera, ForgetsRegionsThatAreOldOrTakenBack) {
  ByHand detector;
  detector.send({ahead()});
  (void)detector.executions(40);
  EXPECT_EQ(detector.sequence, "AaBaCa");
  (void)detector.executions(40);  // 800 ms after the list
  EXPECT_EQ(detector.sequence, "ABC");
  detector.send({ahead()});
  (void)detector.executions(30);
  EXPECT_EQ(detector.sequence, "AaBaCa");
  detector.send({});
  (void)detector.executions(30);
  EXPECT_EQ(detector.sequence, "ABC");
  Region invalid = ahead();
  invalid.valid = false;
  detector.send({invalid});
  (void)detector.executions(30);
  EXPECT_EQ(detector.sequence, "ABC");
}

TEST(AdaptiveCamera, RegionsGrowAndEndAtThePicture) {
  ByHand detector;
  detector.send({{SensorId{2}, 350.0, 0.0, 2.0, 2.0, true}, {SensorId{1}, 400.0, 0.0, 200.0, 200.0, true}});
  (void)detector.executions(40);
  EXPECT_EQ(detector.sequence.find('b'), std::string::npos) << "it lies outside";
  ASSERT_NE(detector.sequence.find('c'), std::string::npos);
  for (const DetectionMade& one : detector.made) {
    if (one.secondary) {
      EXPECT_NEAR(one.area, 41.0 * 64.0 / (720.0 * 720.0), 1e-12);
    }
  }
}

TEST(AdaptiveCamera, APictureThatDoesNotComeCostsAStep) {
  ByHand detector;
  (void)detector.executions(6);
  detector.blind = true;
  EXPECT_EQ(detector.executions(20), "----B---------------") << "its picture was there";
  detector.blind = false;
  EXPECT_NE(detector.executions(6).back(), '-');
}

TEST(AdaptiveCamera, DropsADetectionWhoseTaskPaused) {
  ByHand detector;
  EXPECT_EQ(detector.executions(5), "-----");
  EXPECT_EQ(detector.execute(300), '-');
  EXPECT_TRUE(detector.made.empty());
  EXPECT_EQ(detector.executions(5), "----B");
}

TEST(AdaptiveCamera, DrawsItsTimesAndNeverHoldsForLonger) {
  AdaptiveCameraConfig config;
  config.deviation = 0.5;
  ByHand once(config), again(config);
  EXPECT_EQ(once.executions(400), again.executions(400));
  ASSERT_GT(once.made.size(), 50u);
  double sum = 0.0;
  for (const DetectionMade& one : once.made) {
    EXPECT_LE(one.took, task().holds);
    sum += one.took.seconds();
  }
  EXPECT_NEAR(sum / static_cast<double>(once.made.size()), 0.0463, 0.008);
}

TEST(AdaptiveCamera, HoldsAListForWholeSteps) {
  AdaptiveCameraConfig config;
  config.deviation = 0.5;
  schedules::model::Task longer = task();
  longer.holds = longer.holds + Duration::milliseconds(5);
  ByHand once(config), half_a_step_more(config, longer);
  EXPECT_EQ(once.executions(400), half_a_step_more.executions(400));
  Duration longest{};
  for (const DetectionMade& one : half_a_step_more.made) longest = std::max(longest, one.took);
  EXPECT_EQ(longest, task().holds) << "no detection takes longer than its list was held";
}

TEST(AdaptiveCamera, APlannersRegionsComeAsItWroteThem) {
  schedules::model::Task planner;
  planner.writes = {{"regions", *cluster().find_pdu("regions"), schedules::model::kFlexRay, 0}};
  RegionOutput issued(cluster(), planner);
  std::vector<host::Output> outputs;
  outputs.emplace_back("regions", planner.writes[0].pdu, cluster().pdu(planner.writes[0].pdu));
  host::StepContext context;
  context.outputs = outputs;
  const Region invalid{SensorId{1}, 0.0, 0.0, 1.0, 1.0, false};
  issued.issue(context, std::vector<Region>{ahead(), invalid, {SensorId{2}, -12.0, 7.0, 30.0, 40.0, true}});
  std::vector<Region> read;
  decode_regions(outputs[0].layout(), outputs[0].view(), bind_regions(cluster(), outputs[0].layout()), read);
  ASSERT_EQ(read.size(), 2u);
  EXPECT_EQ(read[0].width, 510.0);
  EXPECT_EQ(read[1].sensor, SensorId{2});
  EXPECT_EQ(read[1].x, -12.0);
  EXPECT_EQ(read[1].y, 7.0);
  EXPECT_TRUE(read[1].holds(18.0, 47.0));
  EXPECT_FALSE(read[1].holds(18.5, 47.0));
}

}  // namespace
}  // namespace ttf::nodes::vision
