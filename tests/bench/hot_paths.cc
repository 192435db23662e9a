// The hot paths, one at a time, to count their instructions (tools/instruction_counts.sh). Only instructions
// inside counted() are counted.
//   ttf_hot_paths --list     their names
//   ttf_hot_paths NAME
#include <cstdio>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "bus/wire/flexray_frame.h"
#include "evaluation/accuracy/plane.h"
#include "fusion/filters/kalman.h"
#include "fusion/filters/unscented.h"
#include "fusion/metrics/object_pairs.h"
#include "fusion/motion/constant_acceleration.h"
#include "fusion/motion/constant_velocity.h"
#include "fusion/motion/ctrv.h"
#include "fusion/sensors/position.h"
#include "sensors/stereo_camera/model.h"
#include "sim/engine/bus_simulation.h"
#include "sim/world/world.h"
#include "tests/bench/crowd.h"
#include "tests/fusion/oosm/any_method.h"
#include "tests/fusion/oosm/timelines.h"
#include "tests/sim/drives/drive_fixture.h"
#include "tests/sim/engine/bus_clusters.h"

namespace ttf {
namespace {

// The counting tool finds it by name.
extern "C" [[gnu::noinline]] void counted(const std::function<void()>& path) { path(); }

// ---- one object

template <class F, class M> void filter_pairs() {
  const F filter;
  const M model{};
  fusion::linear::Gaussian<M::kStates> state;
  state.p.setIdentity();
  fusion::sensors::Measurement<2> z;
  counted([&] {
    for (int i = 0; i < 100; ++i) {
      z.z = {0.1 * i + 0.3 * ((i * 7) % 5), 0.05 * i - 0.2 * ((i * 3) % 4)};
      filter.predict(model, state, 0.05);
      filter.update(model, fusion::sensors::Position{}, z, state);
    }
  });
}

// ---- one object, late

using Plane = fusion::oosm::ConstantVelocity<2>;

// Some lists late, among fifteen that are 40 ms apart.
template <class X, int lag> void late_by() {
  using namespace fusion::oosm;
  constexpr int kLists = 15;
  fusion::linear::LinearMeasurement<4, 2> seen;
  seen.h(0, 0) = seen.h(1, 2) = 1.0;
  const fusion::oosm::Stamp late = fusion::oosm::stamp_at(fusion::oosm::after_ms(40 * (kLists - lag) + 20), 1);
  X method(Plane{});
  method.start(GlobalTime{}, {fusion::linear::Vector<4>::Zero(), fusion::linear::Matrix<4>::Identity()});
  for (int i = 1; i <= kLists; ++i) {
    method.announce(late);
    seen.z = {static_cast<double>(i), static_cast<double>(-i)};
    method.take(fusion::oosm::stamp_at(fusion::oosm::after_ms(40 * i)), seen);
  }
  counted([&] { method.take(late, seen); });
}

// ---- many objects

void cycle_of(const fusion::Crowd& crowd, const fusion::config::TrackerConfig& config) {
  const auto strategy = crowd.start(fusion::strategies::StrategyKind::kAdva, fusion::kWarm, config);
  const auto& laser = crowd.laser[fusion::kWarm];
  const auto& camera = crowd.camera[fusion::kWarm];
  std::vector<fusion::tracks::TrackView> image;
  image.reserve(static_cast<std::size_t>(config.max_objects));
  counted([&] {
    strategy->accept(laser.view());
    strategy->accept(camera.view());
    strategy->fuse(camera.measured + Duration::milliseconds(60));
    strategy->image(camera.measured + Duration::milliseconds(100), image);
  });
}
void fusion_cycle() { cycle_of(fusion::scene(), {}); }
void fusion_cycle_on_the_road() { cycle_of(fusion::road(), {}); }
void fusion_cycle_accelerating() {
  cycle_of(fusion::road(), fusion::config_of(fusion::config::MotionModel::kConstantAcceleration));
}
void fusion_cycle_of_thousand() { cycle_of(fusion::thousand(), fusion::for_thousand()); }
void fusion_cycle_of_thousand_on_the_road() { cycle_of(fusion::thousand_on_the_road(), fusion::for_thousand()); }

// The second late list: the first one finds the tracks of few lists (fusion/tracks/timeline.h).
void fusion_late_list() {
  const auto strategy = fusion::scene().start(fusion::strategies::StrategyKind::kAdva, fusion::kWarm);
  const auto late_list = [&](std::uint32_t k) {
    const auto& late = fusion::scene().laser[k];
    const GlobalTime now = late.measured + Duration::milliseconds(1000);
    strategy->accept(fusion::scene().camera[k].view());
    strategy->accept(fusion::scene().laser[k + 1].view());
    strategy->fuse(now);
    return [&strategy, &late, now] {
      strategy->accept(late.view());
      strategy->fuse(now);
    };
  };
  late_list(fusion::kWarm)();
  strategy->accept(fusion::scene().camera[fusion::kWarm + 1].view());
  counted(late_list(fusion::kWarm + 2));
}

// ---- a thousand people on a square, once (scenarios/thousand.yaml)

std::vector<sim::world::ObjectState> square() {
  sim::world::FieldConfig field;
  field.objects = 1000;
  field.each.heading = 1.5708;
  field.each.length = field.each.width = 0.5;
  sim::world::WorldConfig world;
  world.objects = sim::world::placed(field);
  std::vector<sim::world::ObjectState> states;
  sim::world::World(world, 1, 0).states_at(TrueTime{}, states);
  return states;
}

void camera_of_thousand() {
  const auto objects = square();
  sensors::stereo_camera::CameraConfig camera;
  camera.half_field_rad = 0.8;
  camera.max_range_m = 300.0;
  camera.shadow = 0.0224;
  camera.max_detections = 1000;
  sensors::stereo_camera::CameraRoom room(objects.size());
  std::vector<sensors::stereo_camera::CameraDetection> detections;
  std::vector<ObjectId> truth;
  detections.reserve(1000);
  truth.reserve(1000);
  counted([&] { sensors::stereo_camera::measure_camera(camera, objects, {1, 0, 0, 0}, room, detections, truth); });
}

void object_pairs_of_thousand() {
  std::vector<fusion::metrics::Point> truth, estimates;
  for (const sim::world::ObjectState& state : square()) {
    truth.push_back({state.x, state.y});
    estimates.push_back({state.x + 0.1, state.y - 0.2});
  }
  counted([&] { fusion::metrics::object_pairs(truth, estimates, evaluation::accuracy::kGate_m); });
}

// ---- the bus

struct Frame {
  std::vector<std::byte> payload = std::vector<std::byte>(56, std::byte{0x5A});
  std::vector<std::byte> bytes = std::vector<std::byte>(bus::wire::kMaxFrameBytes);
  bus::wire::FrameHeader header;
  Frame() { header.frame_id = 9; }
  std::size_t encode() { return bus::wire::encode_frame(header, schedules::model::Channel::kA, payload, bytes); }
};
void frame_encode() {
  Frame frame;
  counted([&] {
    for (int i = 0; i < 100; ++i) frame.encode();
  });
}
void frame_decode() {
  Frame frame;
  const std::size_t size = frame.encode();
  counted([&] {
    for (int i = 0; i < 100; ++i)
      bus::wire::decode_frame(schedules::model::Channel::kA, std::span(frame.bytes).first(size));
  });
}

// Four nodes, all 64 static slots in use on both channels, one cycle.
void bus_cycle() {
  schedules::model::Cluster cluster = sim::engine::bus_cluster(4, 3, 4);
  for (int slot = 5; slot <= cluster.flexray.gNumberOfStaticSlots; ++slot)
    cluster.frames.push_back(
        {slot, schedules::model::Channels::kAB, 0, 1, static_cast<NodeId>((slot - 1) % 4), kNoPdu, 0, 0});
  bus::controller::ControllerEvents nobody;
  std::vector<sim::engine::BusNode> nodes;
  for (int n = 0; n < 4; ++n) {
    sim::engine::BusNode node{timebase::Oscillator(25'000, 10'000 * n, 0)};
    node.clock = bus::controller::InitialClock{node.oscillator.ticks_at(TrueTime{1'000'000}), 0};
    nodes.push_back(node);
  }
  sim::engine::BusSimulation simulation(cluster, std::move(nodes),
                                        std::vector<bus::controller::ControllerEvents*>(4, &nobody));
  simulation.run_until(TrueTime{1'000'000} + cluster.cycle() * 10);
  counted([&] { simulation.run_until(simulation.now() + cluster.cycle()); });
}

// The paper's drive of 1.5 s as an experiment drives it: the whole cluster, measured, without a log.
void paper_drive() {
  sim::drives::Drive drive("scenarios/paper_scenario1.yaml", fusion::strategies::StrategyKind::kAdva);
  drive.scenario.duration = Duration::milliseconds(1500);
  drive.scenario.evaluate_from = Duration{};
  evaluation::accuracy::DriveMeasures measures(sim::drives::evaluation_start(drive.scenario));
  counted([&] { drive.run(measures, 1, false); });
}

struct Path {
  const char* name;
  void (*run)();
};
constexpr int kRemembered = 16;
using Rewind = fusion::oosm::Rewind<4, 2, Plane, kRemembered>;
using Augmented = fusion::oosm::Augmented<4, 2, Plane, kRemembered>;
using Clone = fusion::oosm::Clone<4, 2, Plane, 8>;
using Adjoint = fusion::oosm::Adjoint<4, 2, Plane, kRemembered>;
using Al1 = fusion::oosm::Al1<4, 2, Plane, kRemembered>;
using Bl1 = fusion::oosm::Bl1<4, 2, Plane, kRemembered>;
using AlgorithmA = fusion::oosm::AlgorithmA<4, 2, Plane>;
using AlgorithmB = fusion::oosm::AlgorithmB<4, 2, Plane>;
using AlgorithmC = fusion::oosm::AlgorithmC<4, 2, Plane>;
const Path kPaths[] = {
    {"kalman_constant_velocity", filter_pairs<fusion::filters::Kalman, fusion::motion::ConstantVelocity>},
    {"kalman_constant_acceleration", filter_pairs<fusion::filters::Kalman, fusion::motion::ConstantAcceleration>},
    {"unscented_ctrv", filter_pairs<fusion::filters::Unscented, fusion::motion::Ctrv>},
    {"late_rewind_1", late_by<Rewind, 1>},
    {"late_rewind_3", late_by<Rewind, 3>},
    {"late_rewind_5", late_by<Rewind, 5>},
    {"late_rewind_10", late_by<Rewind, 10>},
    {"late_augmented_1", late_by<Augmented, 1>},
    {"late_augmented_3", late_by<Augmented, 3>},
    {"late_augmented_5", late_by<Augmented, 5>},
    {"late_augmented_10", late_by<Augmented, 10>},
    {"late_clone_1", late_by<Clone, 1>},
    {"late_clone_3", late_by<Clone, 3>},
    {"late_clone_5", late_by<Clone, 5>},
    {"late_clone_10", late_by<Clone, 10>},
    {"late_adjoint_1", late_by<Adjoint, 1>},
    {"late_adjoint_3", late_by<Adjoint, 3>},
    {"late_adjoint_5", late_by<Adjoint, 5>},
    {"late_adjoint_10", late_by<Adjoint, 10>},
    {"late_al1_1", late_by<Al1, 1>},
    {"late_al1_3", late_by<Al1, 3>},
    {"late_al1_5", late_by<Al1, 5>},
    {"late_al1_10", late_by<Al1, 10>},
    {"late_bl1_1", late_by<Bl1, 1>},
    {"late_bl1_3", late_by<Bl1, 3>},
    {"late_bl1_5", late_by<Bl1, 5>},
    {"late_bl1_10", late_by<Bl1, 10>},
    {"late_a_1", late_by<AlgorithmA, 1>},
    {"late_b_1", late_by<AlgorithmB, 1>},
    {"late_c_1", late_by<AlgorithmC, 1>},
    {"fusion_cycle", fusion_cycle},
    {"fusion_cycle_on_the_road", fusion_cycle_on_the_road},
    {"fusion_cycle_accelerating", fusion_cycle_accelerating},
    {"fusion_cycle_of_thousand", fusion_cycle_of_thousand},
    {"fusion_cycle_of_thousand_on_the_road", fusion_cycle_of_thousand_on_the_road},
    {"fusion_late_list", fusion_late_list},
    {"camera_of_thousand", camera_of_thousand},
    {"object_pairs_of_thousand", object_pairs_of_thousand},
    {"frame_encode", frame_encode},
    {"frame_decode", frame_decode},
    {"bus_cycle", bus_cycle},
    {"paper_drive", paper_drive},
};

int run(std::string_view name) {
  for (const Path& path : kPaths) {
    if (name == "--list") std::puts(path.name);
    if (name != path.name) continue;
    path.run();
    return 0;
  }
  if (name == "--list") return 0;
  std::fprintf(stderr, "error: no hot path is called '%s'\n", std::string(name).c_str());
  return 2;
}

}  // namespace
}  // namespace ttf

int main(int argc, char** argv) { return ttf::run(argc == 2 ? argv[1] : "--help"); }
