// A sensor that follows its host: device and host, each alone.
#include <gtest/gtest.h>

#include <memory>
#include <optional>
#include <vector>

#include "nodes/host/executive.h"
#include "schedules/file/loader.h"
#include "tests/nodes/host/one_node.h"

namespace ttf::nodes::host {
namespace {

struct Lines final : SensorLines {
  std::vector<Microticks> triggers, strobes;  // with the node's time of the advance in which they came
  Microticks now{};
  void trigger(SensorId) override { triggers.push_back(now); }
  void strobe(SensorId, std::uint32_t) override { strobes.push_back(now); }
};

struct SilentCan final : bus::ports::CanPort {
  void send(const bus::ports::CanFrame&) override {}
};

// One of the two nodes around the camera of the cluster with following sensors. Exact clocks: 40 microticks are a
// microsecond.
struct OneEnd {
  schedules::model::Cluster cluster =
      schedules::file::load_cluster(TTF_SOURCE_DIR "/schedules/paper_free_running.yaml");
  SensorId camera = *cluster.find_sensor("camera");
  std::size_t camera_can = 0;
  bus::NoPort port;
  SilentCan can;
  Lines lines;
  Runs recorded;
  std::unique_ptr<Executive> executive;
  Microticks now{1000};

  explicit OneEnd(const char* name) {
    while (cluster.can_buses[camera_can].name != "camera_can") ++camera_can;
    cluster.sensors[index_of(camera)].phase = Duration::milliseconds(3);
    const NodeId id = *cluster.find_node(name);
    for (schedules::model::Task& task : cluster.nodes[index_of(id)].tasks)
      task.draw = schedules::model::ExecutionDraw::kWorst;
    const bool on_flexray = cluster.node(id).flexray.has_value();
    const ExecutiveConfig config{&cluster,
                                 id,
                                 timebase::Oscillator(25'000, 0, 0),
                                 on_flexray ? std::optional(bus::controller::InitialClock{{1000}, 0}) : std::nullopt,
                                 1,
                                 0,
                                 {}};
    executive = std::make_unique<Executive>(
        config, std::vector<std::shared_ptr<Step>>{std::make_shared<Scripted>()}, on_flexray ? &port : nullptr,
        std::vector<bus::ports::CanPort*>(cluster.can_buses.size(), &can), lines, recorded);
  }
  static Microticks ms(double time) { return {static_cast<std::int64_t>(time * 40'000)}; }
  void run_to(Microticks end) {
    for (Microticks next = executive->next_event(); next <= end; next = executive->next_event()) {
      lines.now = next;
      executive->advance(next);
      ASSERT_GT(executive->next_event(), next) << "L1";
    }
    now = end;
  }
  // The camera's list number `sequence` arrives at its host.
  void list(std::uint32_t sequence) {
    Output raw("raw", *cluster.find_pdu("camera_frame"), cluster.pdu(*cluster.find_pdu("camera_frame")));
    raw.begin(sequence, 0, GlobalTime{});
    executive->receive_can(camera_can, {272, false, raw.view().bytes}, now);
  }
};

// It measures at 3 ms by itself. Triggers come 10 and 40 ms after its last measurement; only the second can
// be obeyed at once. Then triggers cease: 33 ms later it measures by itself.
TEST(FollowingSensor, MeasuresWhenTriggeredIfItCanAndByItselfIfNot) {
  OneEnd device("camera");
  device.run_to(OneEnd::ms(13));
  ASSERT_EQ(device.lines.strobes, (std::vector{OneEnd::ms(3)}));
  device.executive->trigger(device.camera, OneEnd::ms(13));
  EXPECT_EQ(device.executive->next_event(), OneEnd::ms(19)) << "16 ms are its shortest period";
  device.run_to(OneEnd::ms(44));
  device.executive->trigger(device.camera, OneEnd::ms(44));
  device.run_to(OneEnd::ms(90));
  EXPECT_EQ(device.lines.strobes, (std::vector{OneEnd::ms(3), OneEnd::ms(19), OneEnd::ms(44), OneEnd::ms(77)}));
}

TEST(FollowingSensor, PromisesToActAtOnceOnATrigger) {
  EXPECT_EQ(OneEnd("camera").executive->promise().after_trigger, Microticks{});
  EXPECT_EQ(OneEnd("camera_pre").executive->promise().after_can, OneEnd::ms(26)) << "its task's end";
}

// 26 ms of preprocessing.
TEST(FollowingSensor, IsTriggeredWhenItsHostsTaskEnds) {
  OneEnd host("camera_pre");
  host.run_to(OneEnd::ms(2));
  host.list(0);
  host.run_to(OneEnd::ms(40));
  host.list(1);
  host.run_to(OneEnd::ms(80));
  EXPECT_EQ(host.lines.triggers, (std::vector{OneEnd::ms(28), OneEnd::ms(66)}));
}

// The device has measured by itself meanwhile: its next list already waits when the first one is done.
TEST(FollowingSensor, IsNotTriggeredWhileANewerListWaits) {
  OneEnd host("camera_pre");
  host.run_to(OneEnd::ms(2));
  host.list(0);
  host.run_to(OneEnd::ms(10));
  host.list(1);
  host.run_to(OneEnd::ms(80));
  EXPECT_EQ(host.lines.triggers, (std::vector{OneEnd::ms(54)}));
  EXPECT_EQ(host.executive->counts().overruns, 0u);
}

}  // namespace
}  // namespace ttf::nodes::host
