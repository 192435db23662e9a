// The checker's bounds on ages are reached: everything on the laser's way conspires.
//
//   worst   full lists with the most stuff bits, on the raw CAN and on the observation CAN; a camera's frame that began
//           just before the laser's list was queued; every execution at its upper bound; the preprocessing on the
//           slowest possible oscillator and the rest of the cluster on the fastest; and the phase at which the list is
//           written just after its slot began, in the cycle that makes it wait longest for fusion, image and use
//   best    the other way round
#include <gtest/gtest.h>

#include <memory>
#include <optional>

#include "bus/wire/can_timing.h"
#include "schedules/analysis/age_stages.h"
#include "schedules/analysis/ages.h"
#include "sim/drives/step_catalog.h"
#include "tests/sim/drives/dense_lists.h"
#include "tests/sim/drives/drive_fixture.h"

namespace ttf::sim::drives::ages {
namespace {

constexpr std::uint32_t kMeasurement =
    30;  // when the cluster's rate has settled: the one that everything conspires for
const TrueTime kEnd = sim::engine::kFirstCycle + Duration::milliseconds(3000);

// The fate of one of the laser's lists.
struct Followed final : recording::records::Sink {
  using recording::records::Sink::on;
  const schedules::model::Cluster& cluster;
  PduId raw, objects, camera_objects;
  std::uint32_t list;
  std::optional<TrueTime> queued, written;  // on the observation CAN, for FlexRay
  TrueTime camera_before{};                 // the camera's lists queued next to it
  std::optional<TrueTime> camera_after;
  recording::records::CanFrameSent camera_frame;         // the last one of the camera that began before
  std::vector<std::pair<std::int64_t, TrueTime>> slots;  // for its first fragment: cycle, action point
  Duration missing{};                                    // margin of its frames to their worst case
  Duration fused{}, used{};                              // its ages
  std::optional<GlobalTime> measured;
  std::optional<std::uint32_t> image;                                        // the first one with the measurement in it
  std::pair<Duration, Duration> extremes{Duration::milliseconds(1000), {}};  // all the laser's ages when fused

  Followed(const schedules::model::Cluster& c, std::uint32_t sequence)
      : cluster(c), raw(*c.find_pdu("laser_scan")), objects(*c.find_pdu("laser_objects")),
        camera_objects(*c.find_pdu("camera_objects")), list(sequence) {}

  void on(const recording::records::ListHop& hop) override {
    if (hop.hop != recording::records::Hop::kWritten) return;
    if (hop.pdu == camera_objects && hop.can_bus >= 0) {
      if (!queued) camera_before = hop.stamp.true_time;
      if (queued && !camera_after) camera_after = hop.stamp.true_time;
    }
    if (hop.pdu != objects || hop.sequence != list) return;
    (hop.can_bus < 0 ? written : queued) = hop.stamp.true_time;
  }
  void on(const recording::records::SlotFrameSent& sent) override {
    if (sent.pdu == objects && sent.fragment == 0 && sent.channel == 0)
      slots.emplace_back(sent.cycle, sent.stamp.true_time);
  }
  void on(const recording::records::CanFrameSent& sent) override {
    // Reported at its end, it may have been under way when the list was queued.
    if (sent.pdu == camera_objects && (!queued || sent.start.true_time <= *queued)) {
      camera_frame = sent;
      if (queued && sent.end.true_time > *queued) missing += under_worst(sent);
    }
    if ((sent.pdu == raw || sent.pdu == objects) && sent.sequence == list) missing += under_worst(sent);
  }
  void on(const recording::records::ListFused& fusion) override {
    if (fusion.id.sensor != cluster.pdu(objects).sensor) return;
    const Duration age = fusion.stamp.global - fusion.measured;
    extremes = {std::min(extremes.first, age), std::max(extremes.second, age)};
    if (fusion.id.sequence != list) return;
    fused = age;
    measured = fusion.measured;
  }
  void on(const recording::records::ImageWritten& written_image) override {
    if (measured && !image) image = written_image.sequence;
  }
  void on(const recording::records::FeatureUsed& use) override {
    if (image && use.image_sequence == *image && used == Duration{}) used = use.stamp.global - *measured;
  }
  Duration under_worst(const recording::records::CanFrameSent& sent) const {
    const schedules::model::CanBus& bus = cluster.can_buses[sent.bus];
    return schedules::analysis::can_worst_case(bus, static_cast<int>(sent.data.size())) -
           bus::wire::can_frame_duration(bus, sent.identifier, sent.data);
  }
  TrueTime action_point(std::int64_t cycle) const {
    for (const auto& [in, at] : slots)
      if (in == cycle) return at;
    return {};
  }
};

struct Conspiracy {
  Scenario scenario;
  schedules::model::Cluster shipped, cluster;  // as loaded; as simulated
  SensorId laser, camera;
  bool worst;

  explicit Conspiracy(bool for_worst)
      : scenario(load_scenario(sim::drives::shipped("scenarios/paper_scenario1.yaml"))),
        shipped(schedules::file::load_cluster(sim::drives::shipped("schedules/paper_unsynchronised.yaml"))),
        cluster(shipped), laser(*shipped.find_sensor("laser")), camera(*shipped.find_sensor("camera")),
        worst(for_worst) {
    for (schedules::model::Node& node : cluster.nodes) {
      const bool early = node.name == "laser" || node.name == "laser_pre";
      node.drift_ppb = early == worst ? -node.max_drift_ppb : node.max_drift_ppb;
      for (schedules::model::Task& task : node.tasks) {
        if (!worst) task.worst_case = task.best_case;
        task.draw = schedules::model::ExecutionDraw::kWorst;
      }
    }
    for (const SensorId sensor : {laser, camera}) cluster.sensors[index_of(sensor)].phase = Duration{};
    // An identifier whose arbitration field takes the most stuff bits: 0 0000 [1] 1111 [0] 000 00 [1] 1 0 1;
    // and one that takes zero. The messages keep their order.
    for (schedules::model::CanBus& bus : cluster.can_buses)
      for (schedules::model::CanMessage& message : bus.messages)
        if (cluster.pdu(message.pdu).sensor == laser)
          message.identifier = worst ? 0x078 : 0x255;
        else
          message.identifier = 0x478;
  }

  // The sequence number's bits need stuff bits too: 1000 0111 1000 0111 at the measurement that counts.
  std::uint32_t first_sequence() const { return worst ? 0x8787 - kMeasurement : 0x5555 - kMeasurement; }

  std::vector<std::shared_ptr<nodes::host::Step>> steps(NodeId id) const {
    const schedules::model::Node& node = cluster.node(id);
    const schedules::model::Task& task = node.tasks.at(0);
    if (node.name == "camera" && !worst) return {std::make_shared<SilentStep>()};
    const Filling filling = worst ? Filling::kDense : Filling::kSparse;
    if (node.name == "laser" || node.name == "laser_pre")
      return {std::make_shared<FilledStep>(cluster, task, first_sequence(), filling)};
    if (node.name == "camera" || node.name == "camera_pre")
      return {std::make_shared<FilledStep>(cluster, task, 0, filling)};
    return make_steps({&scenario, &cluster, fusion::strategies::StrategyKind::kAdva, 1, 0, nullptr, nullptr}, id);
  }

  Followed run() const {
    Followed seen(cluster, first_sequence() + kMeasurement);
    sim::engine::ClusterSimulation simulation({&cluster, 1, 0, [this](NodeId id) { return steps(id); }}, seen);
    simulation.run_until(kEnd);
    EXPECT_EQ(simulation.counts().deadlines_missed, 0u);
    EXPECT_EQ(simulation.counts().torn_lists, 0u);
    EXPECT_EQ(simulation.counts().overwritten_lists, 0u);
    return seen;
  }

  // Moves the sensors' phases. Then the list is written within some microticks after its slot's action point
  // (before it, for the best), and a camera's frame began as shortly before the list was queued. The camera
  // comes first, and then moves with the laser: its frame shifts the laser's list.
  Followed closed_in() {
    static constexpr Duration kAim{75}, kNear{400};  // a phase moves the list by steps of some 400 ns
    const auto near = [](Duration d) { return d > Duration{} && d <= kNear; };
    std::optional<std::int64_t> cycle;
    for (int round = 0; round < 12; ++round) {
      Followed seen = run();
      Duration behind = *seen.queued - seen.camera_before;
      if (worst && !near(*seen.queued - seen.camera_frame.start.true_time)) {
        if (seen.camera_after && *seen.camera_after - *seen.queued < behind) behind = *seen.queued - *seen.camera_after;
        move(camera, behind - kAim);
        continue;
      }
      for (const auto& [in, at] : seen.slots)
        if (!cycle && in % 8 == 0 && at > *seen.written) cycle = in;
      const Duration past = *seen.written - seen.action_point(*cycle);
      if (near(worst ? past : -past)) return seen;
      for (const SensorId sensor : {laser, camera}) move(sensor, (worst ? kAim : -kAim) - past);
    }
    ADD_FAILURE() << "the phases do not close in";
    return run();
  }

  // By an amount of true time; phases are on the device's own clock.
  void move(SensorId id, Duration later) {
    schedules::model::Sensor& sensor = cluster.sensors[index_of(id)];
    *sensor.phase += later + Duration{later.ns / 1000 * *cluster.node(sensor.device).drift_ppb / 1'000'000};
  }

  schedules::analysis::AgePath bounds() const {
    for (const schedules::analysis::AgePath& path : schedules::analysis::measurement_ages(shipped))
      if (path.sensor == laser) return path;
    return {};
  }
};

// The rest to the bound, besides stuff bits that the lists' sequence, fragment and count do not need:
//   34 us  the wait for slot and fusion on a clock 3000 ppm off the cluster's (3000 ppm of 11.4 ms)
//    8 us  clocks apart by the assumed precision and a macrotick
//   27 us  CAN bits are exact in true time, half of those 3000 ppm away from the cluster's (of 17.5 ms)
//    7 us  the list may be written until its slot's action point, the bound takes the slot's start
//    4 us  each list's frames end in whole nanoseconds, microticks, a microsecond of the time stamp
TEST(AdverseAges, TheWorstIsReached) {
  Conspiracy all(true);
  const schedules::analysis::AgePath bound = all.bounds();
  const Followed seen = all.closed_in();
  EXPECT_LE(seen.fused, bound.fused_worst);
  EXPECT_LE(seen.used, bound.use_worst);
  EXPECT_LE(seen.extremes.second, bound.fused_worst);
  EXPECT_LT(bound.fused_worst - seen.fused - seen.missing, Duration::microseconds(80));
  EXPECT_LT(seen.missing, Duration::microseconds(150));
  // Until the use, everything else is on the grid; another clock gives another length.
  const Duration on_grid = bound.use_worst - bound.fused_worst;
  EXPECT_LT(bound.use_worst - seen.used - seen.missing, Duration::microseconds(80) + Duration{on_grid.ns * 3 / 1000});
}

// Lists of one fragment, free CANs, and every oscillator off to the other side.
TEST(AdverseAges, TheBestIsReached) {
  Conspiracy all(false);
  const schedules::analysis::AgePath bound = all.bounds();
  const Followed seen = all.closed_in();
  EXPECT_GE(seen.fused, bound.fused_best);
  EXPECT_GE(seen.used, bound.use_best);
  EXPECT_GE(seen.extremes.first, bound.fused_best);
  EXPECT_LT(seen.fused - bound.fused_best, Duration::microseconds(40));
  EXPECT_LT(seen.used - bound.use_best, Duration::microseconds(60));
}

}  // namespace
}  // namespace ttf::sim::drives::ages
