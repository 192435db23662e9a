// The simulated media obey the laws of the ports.
#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <memory>
#include <span>
#include <vector>

#include "sim/medium/can_medium.h"
#include "sim/medium/flexray_medium.h"
#include "tests/bus/layouts.h"
#include "tests/laws/can_port_laws.h"
#include "tests/laws/flexray_port_laws.h"
#include "tests/sim/medium/simulated_flexray.h"
#include "timebase/oscillator.h"

namespace ttf::laws {
namespace {

constexpr std::size_t kNodes = 4;
constexpr std::size_t kRoom = 4096;

// Node 2 has no FlexRay controller: it is not on the line, and the others are still equally spaced.
schedules::model::Cluster on_flexray() {
  schedules::model::Cluster cluster;
  cluster.nodes.resize(kNodes + 1);
  for (std::size_t n = 0; n < cluster.nodes.size(); ++n)
    if (n != 2) cluster.nodes[n].flexray.emplace();
  return cluster;
}

class SimulatedFlexRayBench final : public SimulatedFlexRay {
 public:
  SimulatedFlexRayBench() : SimulatedFlexRay(on_flexray()) {}
};

// Node 1 is on no CAN. The schedule has two of the identifiers; frames too short for their PDU are still
// delivered.
schedules::model::Cluster on_can(bool flexible_data_rate) {
  schedules::model::Cluster cluster;
  cluster.nodes.resize(kNodes + 1);
  cluster.pdus = {bus::list_layout(4, 3, 3)};
  schedules::model::CanBus bus;
  bus.name = "can";
  bus.flexible_data_rate = flexible_data_rate;
  bus.nominal_bit_rate = 1'000'000;
  bus.data_bit_rate = flexible_data_rate ? 5'000'000 : 1'000'000;
  bus.messages = {{PduId{0}, 7, NodeId{0}, Duration::milliseconds(10), 0},
                  {PduId{0}, 0, NodeId{0}, Duration::milliseconds(10), 0}};
  cluster.can_buses = {bus};
  return cluster;
}

// The medium's reports agree with its acts: frames one after the other. Each reports its begin; it is accepted at its
// sender's event, and the bus is busy for four more bits of 1 us. The frame's sender gives its meaning
// (nodes/host/executive.h).
struct Reported final : recording::records::Sink {
  using recording::records::Sink::on;
  std::size_t frames = 0;
  Duration busy{};
  TrueTime start{}, idle{};
  void on(const recording::records::CanFrameSent& sent) override {
    EXPECT_EQ(sent.pdu, kNoPdu);
    EXPECT_GE(sent.start.true_time, idle);
    start = sent.start.true_time;
  }
  void accepted(TrueTime at) {
    ++frames;
    EXPECT_LT(start, at);
    idle = at + Duration::microseconds(4);
    busy += idle - start;
  }
};

template <bool kFlexibleDataRate, bool kBitByBit> class SimulatedCanBench final : public CanBench {
 public:
  SimulatedCanBench() {
    for (std::size_t c = 0; c < kNodes; ++c) ports_.push_back(std::make_unique<Port>(*this, c));
    medium_.set_bit_by_bit(kBitByBit);
  }
  ~SimulatedCanBench() override {
    EXPECT_EQ(reported_.frames * (kNodes - 1), reached_.size());
    EXPECT_EQ(reported_.busy, medium_.busy());
  }
  bool flexible_data_rate() const override { return kFlexibleDataRate; }
  std::size_t controllers() const override { return kNodes; }
  bus::ports::CanPort& port(std::size_t controller) override { return *ports_[controller]; }
  void begin() override {
    const TrueTime now = now_;
    while (!queue_.empty() && queue_.next().time == now) next();
  }
  void run_until_idle() override {
    while (!queue_.empty()) next();
  }
  const std::vector<CanReached>& reached() const override { return reached_; }

 private:
  struct Port final : bus::ports::CanPort {
    SimulatedCanBench& bench;
    std::size_t controller;
    Port(SimulatedCanBench& b, std::size_t c) : bench(b), controller(c) {}
    void send(const bus::ports::CanFrame& frame) override {
      bench.medium_.send(kMembers[controller], bench.now_, frame);
    }
  };
  void next() {
    now_ = queue_.next().time;
    const sim::medium::MediumEvent event = queue_.pop();
    if (event.kind == sim::medium::MediumEvent::Kind::kCanArbitration) {
      medium_.arbitrate(now_);
      return;
    }
    if (event.kind == sim::medium::MediumEvent::Kind::kCanBits) return medium_.end_bits(now_);
    if (event.kind == sim::medium::MediumEvent::Kind::kCanSent) return reported_.accepted(now_);
    ASSERT_EQ(event.kind, sim::medium::MediumEvent::Kind::kCanArrival);
    const auto member = std::find(std::begin(kMembers), std::end(kMembers), static_cast<NodeId>(event.node));
    ASSERT_NE(member, std::end(kMembers));
    const auto bytes = pool_.bytes(event.frame);
    reached_.push_back({static_cast<std::size_t>(member - std::begin(kMembers)),
                        event.identifier,
                        event.flexible_data_rate,
                        {bytes.begin(), bytes.end()}});
    pool_.release(event.frame);
  }

  static constexpr NodeId kMembers[kNodes] = {NodeId{0}, NodeId{2}, NodeId{3}, NodeId{4}};
  schedules::model::Cluster cluster_ = on_can(kFlexibleDataRate);
  sim::medium::MediumQueue queue_{kRoom};
  sim::medium::FramePool pool_{kRoom};
  Reported reported_;
  sim::medium::CanMedium medium_{cluster_, 0, kMembers, queue_, pool_, reported_, 1, 0};
  TrueTime now_{1'000};
  std::vector<std::unique_ptr<Port>> ports_;
  std::vector<CanReached> reached_;
};

using CanBenches = testing::Types<SimulatedCanBench<false, false>, SimulatedCanBench<true, false>,
                                  SimulatedCanBench<false, true>, SimulatedCanBench<true, true>>;

}  // namespace

INSTANTIATE_TYPED_TEST_SUITE_P(SimulatedMedium, FlexRayPortLaws, SimulatedFlexRayBench);
INSTANTIATE_TYPED_TEST_SUITE_P(SimulatedMedium, CanPortLaws, CanBenches);

}  // namespace ttf::laws
