// Lists that reach a node over its CAN: read once, overwritten, or discarded without a strobe for their time.
#include <gtest/gtest.h>

#include <algorithm>
#include <optional>

#include "nodes/host/executive.h"
#include "schedules/file/loader.h"
#include "sensors/stereo_camera/preprocessing.h"
#include "tests/nodes/host/one_node.h"

namespace ttf::nodes::host {
namespace {

struct NoCan final : bus::ports::CanPort {
  void send(const bus::ports::CanFrame&) override {}
};

// The paper's camera host with its step, on separate wires.
struct CameraHost {
  schedules::model::Cluster cluster =
      schedules::file::load_cluster(TTF_SOURCE_DIR "/schedules/paper_synchronised.yaml");
  NodeId id = *cluster.find_node("camera_pre");
  SensorId camera = *cluster.find_sensor("camera");
  const schedules::model::PduLayout& layout = cluster.pdu(*cluster.find_pdu("camera_frame"));
  std::size_t camera_can = 0;
  bus::NoPort port;
  NoCan can;
  NoLines lines;
  Runs recorded;
  std::unique_ptr<Executive> executive;
  Microticks now{1000};

  // Integrated from the start, or (without a clock) starting up on a silent bus, for ever.
  explicit CameraHost(std::optional<bus::controller::InitialClock> clock = bus::controller::InitialClock{{1000}, 0}) {
    while (cluster.can_buses[camera_can].name != "camera_can") ++camera_can;
    const schedules::model::Task& task = cluster.node(id).tasks[0];
    const ExecutiveConfig config{&cluster, id, timebase::Oscillator(25'000, 0, 0), clock, 1, 0, {}};
    executive = std::make_unique<Executive>(
        config,
        std::vector<std::shared_ptr<Step>>{std::make_shared<sensors::stereo_camera::CameraPreprocessing>(
            cluster, task, sensors::stereo_camera::CameraCalibration{})},
        &port, std::vector<bus::ports::CanPort*>(cluster.can_buses.size(), &can), lines, recorded);
  }
  void wait(Duration duration) {
    const Microticks end = now + Microticks{duration.ns / 25};
    for (Microticks next = executive->next_event(); next <= end; next = executive->next_event())
      executive->advance(next);
    now = end;
  }
  // One detection, as the camera sends it.
  void frame(std::uint32_t sequence) {
    Output raw("raw", *cluster.find_pdu("camera_frame"), layout);
    raw.begin(sequence, 1, GlobalTime{});
    const double values[] = {0.0, 20.0, 90.0};
    for (std::size_t s = 0; s < 3; ++s) raw.set(0, s, values[s]);
    executive->receive_can(camera_can, {272, false, raw.view().bytes}, now);
  }
  long hops(recording::records::Hop what) const {
    return std::count_if(recorded.hops.begin(), recorded.hops.end(),
                         [&](const Runs::Hop& h) { return h.what == what; });
  }
};

TEST(ExecutiveLists, AListIsReadOnceAndItsResultWritten) {
  CameraHost host;
  host.executive->strobe(host.camera, 0, host.now);
  host.wait(Duration::milliseconds(1));
  host.frame(0);
  host.wait(Duration::milliseconds(60));
  EXPECT_EQ(host.hops(recording::records::Hop::kReceived), 1);
  EXPECT_EQ(host.hops(recording::records::Hop::kRead), 1);
  EXPECT_EQ(host.hops(recording::records::Hop::kWritten), 1);
  EXPECT_EQ(host.hops(recording::records::Hop::kDiscarded), 0);
  EXPECT_EQ(host.executive->counts().discarded_lists, 0u);
}

TEST(ExecutiveLists, AListWithoutAStrobeIsDiscardedCountedAndRecorded) {
  CameraHost host;
  host.executive->strobe(host.camera, 0, host.now);
  host.wait(Duration::milliseconds(1));
  host.frame(1);  // its strobe was lost
  host.wait(Duration::milliseconds(60));
  EXPECT_EQ(host.hops(recording::records::Hop::kRead), 1);
  EXPECT_EQ(host.hops(recording::records::Hop::kWritten), 0);
  ASSERT_EQ(host.hops(recording::records::Hop::kDiscarded), 1);
  EXPECT_EQ(host.recorded.hops.back().sequence, 1u);
  EXPECT_EQ(host.executive->counts().discarded_lists, 1u);
  host.executive->strobe(host.camera, 2, host.now);
  host.frame(2);
  host.wait(Duration::milliseconds(60));
  EXPECT_EQ(host.hops(recording::records::Hop::kWritten), 1) << "the next one is used again";
  EXPECT_EQ(host.executive->counts().discarded_lists, 1u);
}

// The camera restarts when its host is at 3000 of the field's 4096: the next list seems to be 1096 further
// on.
TEST(ExecutiveLists, TheDevicesRestartIsNoReasonToDiscard) {
  CameraHost host;
  const auto measured = [&](std::uint32_t sequence) {
    host.executive->strobe(host.camera, sequence, host.now);
    host.frame(sequence);
    host.wait(Duration::milliseconds(40));
  };
  measured(3000);
  for (std::uint32_t k = 0; k < 3; ++k) measured(k);
  EXPECT_EQ(host.hops(recording::records::Hop::kDiscarded), 0);
  EXPECT_EQ(host.hops(recording::records::Hop::kWritten), 4);
  EXPECT_EQ(host.recorded.hops.back().what, recording::records::Hop::kWritten);
  EXPECT_EQ(host.recorded.hops.back().sequence, 2u) << "under the device's own number";
}

// During start-up a host has only a local clock, which means nothing to others.
TEST(ExecutiveLists, WithoutGlobalTimeThereIsNoTimeOfMeasuring) {
  CameraHost host(std::nullopt);
  host.executive->strobe(host.camera, 0, host.now);
  host.frame(0);
  host.wait(Duration::milliseconds(60));
  EXPECT_EQ(host.hops(recording::records::Hop::kRead), 1);
  EXPECT_EQ(host.hops(recording::records::Hop::kDiscarded), 1);
  EXPECT_EQ(host.hops(recording::records::Hop::kWritten), 0);
}

TEST(ExecutiveLists, AnUnreadListReplacedByANewerOneIsCounted) {
  CameraHost host;
  for (std::uint32_t k = 0; k < 3; ++k) {
    host.executive->strobe(host.camera, k, host.now);
    host.frame(k);
    host.wait(Duration::milliseconds(1));  // the first is being processed
  }
  host.wait(Duration::milliseconds(120));
  EXPECT_EQ(host.hops(recording::records::Hop::kReceived), 3);
  EXPECT_EQ(host.hops(recording::records::Hop::kOverwritten), 1);
  EXPECT_EQ(host.executive->counts().overwritten_lists, 1u);
  EXPECT_EQ(host.hops(recording::records::Hop::kRead), 2);
}

}  // namespace
}  // namespace ttf::nodes::host
