// A controller's wake-up: its timers run as specified, and it always ends.
#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include "tests/bus/alone.h"
#include "tests/bus/startup_cluster.h"

namespace ttf::bus::controller {
namespace {

// A coldstart node whose host commanded WAKEUP at 0. Its listen time-out ends after two cycles of silence.
// Then it sends its pattern on channel A.
struct Waking {
  schedules::model::Cluster cluster;
  NoPort port;
  Reports reports;
  FlexRayController controller{cluster, NodeId{0}, port, reports};

  explicit Waking(schedules::model::Cluster made = patient_cluster()) : cluster(std::move(made)) {
    for (const auto command :
         {poc::PocEventKind::kConfig, poc::PocEventKind::kConfigComplete, poc::PocEventKind::kWakeup})
      controller.command(command, {});
  }
  // The noise timer ends no phase here.
  static schedules::model::Cluster patient_cluster() {
    schedules::model::Cluster cluster = startup_cluster(2);
    cluster.flexray.gListenNoise = 16;
    return cluster;
  }
  Microticks timeout() const { return {cluster.nodes[0].flexray->pdListenTimeout}; }
  poc::PocKind kind() const { return controller.state().kind; }
  poc::WakeupStatus status() const { return controller.state().wakeup_status; }
  void receive_noise(Microticks start, Microticks end) {
    controller.advance(end - Microticks{1});
    controller.receive({Channel::kA, ports::Signal::kUndecodable, start, end, {}});
  }
  void receive_pattern() {
    controller.advance({10'000});
    controller.receive({Channel::kA, ports::Signal::kWakeup, {10'000 - 1'920}, {10'000}, {}});
  }
  // Noise into the pattern: a collision, received until the end of that noise.
  Microticks collide() {
    controller.advance(timeout());
    EXPECT_EQ(kind(), poc::PocKind::kWakeupSend);
    const Microticks end = timeout() + Microticks{500};
    receive_noise(timeout() + Microticks{100}, end);
    EXPECT_EQ(kind(), poc::PocKind::kWakeupDetect);
    return end;
  }
};

TEST(Wakeup, AfterSilenceThePatternIsSentAndTheNodeIsReady) {
  Waking node;
  node.controller.advance(node.timeout() - Microticks{1});
  EXPECT_EQ(node.kind(), poc::PocKind::kWakeupListen);
  node.controller.advance(node.timeout());
  ASSERT_EQ(node.port.sent.size(), 1u);
  EXPECT_EQ(node.port.sent[0].signal, ports::Signal::kWakeup);
  node.controller.advance(node.port.sent[0].end);
  EXPECT_EQ(node.kind(), poc::PocKind::kReady);
  EXPECT_EQ(node.status(), poc::WakeupStatus::kTransmitted);
}

// A channel that is busy at the timer's end has stopped the timer. The node listens again afterwards.
TEST(Wakeup, WhileListeningTheTimerFollowsTheChannels) {
  Waking node;
  node.port.busy[0] = true;
  node.controller.advance(node.timeout());
  EXPECT_EQ(node.kind(), poc::PocKind::kWakeupListen);
  node.port.busy[0] = false;
  const Microticks end = node.timeout() + Microticks{300};
  node.receive_noise(node.timeout() - Microticks{100}, end);
  node.controller.advance(end + node.timeout());
  EXPECT_EQ(node.kind(), poc::PocKind::kWakeupListen);  // since channel idle was recognised: some bits later
  node.controller.advance(end + node.timeout() + Microticks{11 * 4});
  EXPECT_EQ(node.kind(), poc::PocKind::kWakeupSend);
}

TEST(Wakeup, AnotherNodesPatternEndsTheWakeUp) {
  Waking node;
  node.receive_pattern();
  EXPECT_EQ(node.kind(), poc::PocKind::kReady);
  EXPECT_EQ(node.status(), poc::WakeupStatus::kReceivedPattern);
}

// The idle phases of the senders are shorter than this receiver asks for.
TEST(Wakeup, APatternThatTheReceiverDoesNotRecogniseIsNone) {
  schedules::model::Cluster cluster = Waking::patient_cluster();
  cluster.flexray.gdWakeupSymbolTxIdle = 45;
  Waking node(cluster);
  node.receive_pattern();
  EXPECT_EQ(node.kind(), poc::PocKind::kWakeupListen);
}

// A leading node gives way to another node's collision avoidance symbol, up to gdCASRxLowMax = 91 bits of four
// microticks. So long are two that overlap. A longer low phase is none.
TEST(CollisionAvoidanceSymbol, IsNoneIfItIsTooLong) {
  for (const std::int64_t length : {39 * 4, 91 * 4, 91 * 4 + 1, 2'000}) {
    const schedules::model::Cluster cluster = startup_cluster(2);
    NoPort port;
    Reports reports;
    FlexRayController controller(cluster, NodeId{0}, port, reports);
    controller.start_cold({});
    const Microticks sent{cluster.nodes[0].flexray->pdListenTimeout};
    controller.advance(sent);
    ASSERT_EQ(controller.state().kind, poc::PocKind::kColdstartCollisionResolution);
    const Microticks start = sent + Microticks{20'000};
    controller.advance(start);
    controller.receive({Channel::kA, ports::Signal::kCas, start, start + Microticks{length}, {}});
    EXPECT_EQ(controller.state().kind,
              length <= 91 * 4 ? poc::PocKind::kColdstartListen : poc::PocKind::kColdstartCollisionResolution)
        << length;
  }
}

TEST(Wakeup, ACollisionThatNothingExplainsEndsWithTheListenTimer) {
  Waking node;
  const Microticks collision = node.collide();
  node.controller.advance(collision + node.timeout() - Microticks{1});
  EXPECT_EQ(node.kind(), poc::PocKind::kWakeupDetect);
  node.controller.advance(collision + node.timeout());
  EXPECT_EQ(node.kind(), poc::PocKind::kReady);
  EXPECT_EQ(node.status(), poc::WakeupStatus::kCollisionUnknown);
}

// In search of the collision's cause, that timer is the only bound: it runs regardless of the channel.
TEST(Wakeup, ABusyChannelDoesNotKeepTheCollisionUnexplainedForEver) {
  Waking node;
  const Microticks collision = node.collide();
  node.port.busy[0] = true;
  node.controller.advance(collision + node.timeout());
  EXPECT_EQ(node.kind(), poc::PocKind::kReady);
  EXPECT_EQ(node.status(), poc::WakeupStatus::kCollisionUnknown);
}

// Back to back, as the timer expires in the middle of one of them.
TEST(Wakeup, NoiseUponNoiseDoesNotEither) {
  Waking node;
  Microticks at = node.collide();
  const Microticks expires = at + node.timeout();
  for (; at < expires + Microticks{5'000}; at = at + Microticks{2'400}) {
    node.controller.advance(at);
    node.port.busy[0] = true;
    node.controller.advance(at + Microticks{2'319});
    node.port.busy[0] = false;
    node.receive_noise(at, at + Microticks{2'320});
  }
  EXPECT_EQ(node.kind(), poc::PocKind::kReady);
  EXPECT_EQ(node.status(), poc::WakeupStatus::kCollisionUnknown);
}

}  // namespace
}  // namespace ttf::bus::controller
