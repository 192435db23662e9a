// The laws of sim/faults/injector.h, and the faults' effects on bytes.
#include "sim/faults/injector.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <set>

#include "bus/wire/flexray_frame.h"
#include "tests/sim/faults/fault_bus.h"
#include "tests/support/allocation_counter.h"

namespace ttf::sim::faults {
namespace {

using schedules::model::Channel;
using ttf::faults::FaultKind;

// Lasts to the end.
bool kind_lasts(FaultKind kind) { return kind == FaultKind::kWrongSchedule || kind == FaultKind::kDrift; }

// One of every kind, at different nodes or times where they would hide each other.
std::vector<ttf::faults::Fault> every_kind() {
  std::vector<ttf::faults::Fault> faults;
  for (const FaultKind kind : ttf::faults::kAllFaultKinds) {
    if (ttf::faults::is_on_can(kind)) continue;  // the last ones; here is no CAN (can_faults_test.cc)
    ttf::faults::Fault fault =
        fault_of(kind, static_cast<int>(faults.size() % 6), 10 + 6 * static_cast<int>(faults.size()), 5);
    if (kind == FaultKind::kMasquerading) fault.slot = 40;
    if (kind == FaultKind::kSosTiming) fault.shift = Duration::microseconds(8);
    if (kind == FaultKind::kByzantineClock) fault.shift = Duration::microseconds(3);
    if (kind == FaultKind::kDrift) fault.drift_ppb = 200'000;
    if (kind == FaultKind::kLoneColdstart || kind == FaultKind::kDuplicateColdstart) fault.node = NodeId{0};
    if (kind == FaultKind::kWrongSchedule) {
      fault.node = NodeId{5};
      fault.by = 10;
    }
    if (kind == FaultKind::kNoise || kind == FaultKind::kBabblingIdiot) fault.jitter = Duration::milliseconds(1);
    if (kind == FaultKind::kOmission || kind == FaultKind::kSosTiming) fault.probability = 0.5;
    fault.flips = 3;
    if (kind_lasts(kind)) fault.duration = ttf::faults::Fault::kToTheEnd;
    faults.push_back(fault);
  }
  return faults;
}

FaultBusConfig six(std::vector<ttf::faults::Fault> faults, std::uint64_t seed = 1) {
  FaultBusConfig config;
  config.cluster = engine::bus_cluster(6, 3, 6);
  config.faults = std::move(faults);
  config.seed = seed;
  return config;
}

TEST(Injector, EveryKindBeginsActsAndIsCounted) {
  FaultBus bus(six(every_kind()));
  bus.run(5 * 130);
  for (std::size_t i = 0; i < every_kind().size(); ++i) {
    SCOPED_TRACE(ttf::faults::name_of(ttf::faults::kAllFaultKinds[i]));
    std::uint64_t acts = 0, begins = 0, ends = 0;
    TrueTime first{}, last{};
    for (const FaultBus::Activity& activity : bus.activities()) {
      if (activity.fault != i) continue;
      EXPECT_EQ(activity.kind, ttf::faults::name_of(ttf::faults::kAllFaultKinds[i]));
      EXPECT_FALSE(activity.text.empty());
      begins += activity.what == recording::records::FaultAct::kBegins ? 1 : 0;
      ends += activity.what == recording::records::FaultAct::kEnds ? 1 : 0;
      if (activity.what != recording::records::FaultAct::kActs) continue;
      if (acts++ == 0) first = activity.at;
      last = activity.at;
      EXPECT_EQ(begins, 1U) << "it acts after it begins";
      EXPECT_EQ(ends, 0U) << "and not after it ends";
    }
    EXPECT_EQ(begins, 1U);
    EXPECT_EQ(ends, kind_lasts(ttf::faults::kAllFaultKinds[i]) ? 0U : 1U);
    EXPECT_GT(acts, 0U);
    EXPECT_EQ(bus.acts(i), acts);
    EXPECT_EQ(bus.injector().activations()[i].first, first);
    EXPECT_EQ(bus.injector().activations()[i].last, last);
  }
}

TEST(Injector, L1TheSameSeedGivesTheSameRecordsAndAnotherOneOthers) {
  FaultBus one(six(every_kind(), 7)), again(six(every_kind(), 7)), other(six(every_kind(), 8));
  for (FaultBus* bus : {&one, &again, &other}) bus->run(5 * 130);
  EXPECT_EQ(one.everything(), again.everything());
  EXPECT_NE(one.everything(), other.everything());
}

TEST(Injector, L2WhatAFaultDrawsDoesNotDependOnTheOthers) {
  ttf::faults::Fault omission = fault_of(FaultKind::kOmission, 1, 10);
  omission.probability = 0.4;
  ttf::faults::Fault flips = fault_of(FaultKind::kBitFlipPayload, 2, 10);
  flips.probability = 0.6;
  FaultBus alone(six({omission})), beside(six({omission, flips}));
  for (FaultBus* bus : {&alone, &beside}) bus->run(5 * 60);
  ASSERT_GT(alone.acts(), 0U);
  ASSERT_GT(beside.acts(1), 0U);
  const auto at = [](const FaultBus& bus) {
    // By cycles: clock corrections depend on the received nodes.
    std::vector<std::int64_t> cycles;
    for (const FaultBus::Activity& activity : bus.activities())
      if (activity.fault == 0) cycles.push_back((activity.at.ns + kCycleNs / 4) / kCycleNs);
    return cycles;
  };
  EXPECT_EQ(at(alone), at(beside));
}

TEST(Injector, L3WithoutFaultsNothingIsDifferent) {
  for (const bool cold : {false, true}) {
    FaultBusConfig config = six({}), nobody = six({});
    nobody.inject = false;
    config.cold = nobody.cold = cold;
    FaultBus with(std::move(config)), without(std::move(nobody));
    with.run(5 * 60);
    without.run(5 * 60);
    EXPECT_EQ(with.everything(), without.everything());
    EXPECT_FALSE(with.everything().empty());
  }
}

TEST(Injector, L3AFaultThatIsStillToComeChangesNothing) {
  ttf::faults::Fault fault = fault_of(FaultKind::kTransient, -1, 61, 5);
  FaultBus with(six({fault})), without(six({}));
  with.run(5 * 60);
  without.run(5 * 60);
  EXPECT_EQ(with.everything(), without.everything());
}

// Stands for a simulation: remembers its calls.
struct Listener final : engine::Plant {
  TrueTime time{};
  std::vector<std::string> asked;
  TrueTime now() const override { return time; }
  bool powered(NodeId) const override { return true; }
  void power_off(NodeId node) override { asked.push_back(fmt::format("off {}", index_of(node))); }
  void power_on(NodeId node, TrueTime at) override { asked.push_back(fmt::format("on {} {}", index_of(node), at.ns)); }
  void change_drift(NodeId node, std::int64_t ppb) override {
    asked.push_back(fmt::format("drift {} {}", index_of(node), ppb));
  }
  void emit(const medium::Leaving&, std::optional<NodeId>) override {}
};

class Bytes : public testing::Test {
 protected:
  Bytes() {
    bus::wire::FrameHeader header;
    header.frame_id = 3;
    header.cycle = 17;
    std::array<std::byte, 16> payload{};
    for (std::size_t i = 0; i < payload.size(); ++i) payload[i] = static_cast<std::byte>(31 * i);
    size_ = bus::wire::encode_frame(header, Channel::kB, payload, frame_);
  }
  // The signal that leaves node 2 on channel B when it sends the frame.
  std::vector<std::byte> left(Injector& injector) {
    medium::Leaving signal{
        NodeId{2}, Channel::kB, bus::ports::Signal::kFrame, plant_.time, plant_.time + Duration{26'300}, frame()};
    EXPECT_TRUE(injector.leaving(signal));
    return {signal.bytes.begin(), signal.bytes.end()};
  }
  std::span<const std::byte> frame() const { return std::span<const std::byte>(frame_).first(size_); }
  std::vector<int> flipped(const std::vector<std::byte>& bytes) const {
    std::vector<int> bits;
    for (int bit = 0; bit < 8 * static_cast<int>(bytes.size()); ++bit) {
      const auto byte = static_cast<std::size_t>(bit / 8);
      if (((bytes[byte] ^ frame_[byte]) & (std::byte{0x80} >> (bit % 8))) != std::byte{0}) bits.push_back(bit);
    }
    return bits;
  }
  ttf::faults::FaultPlan plan(ttf::faults::Fault fault) const { return {"", {std::move(fault)}}; }

  schedules::model::Cluster cluster_ = engine::bus_cluster(4, 2, 4);
  Listener plant_;
  recording::records::Sink nobody_;
  std::array<std::byte, bus::wire::kMaxFrameBytes> frame_{};
  std::size_t size_ = 0;
};

TEST_F(Bytes, GivenBitsAreInvertedAndNoOthers) {
  const struct {
    FaultKind kind;
    std::vector<int> bits, expected;
  } cases[] = {
      {FaultKind::kBitFlipHeader, {0, 39}, {0, 39}},
      {FaultKind::kBitFlipPayload, {0, 127}, {40, 167}},
      {FaultKind::kBitFlipPayload, {127, 128}, {167}},  // the frame ends here
      {FaultKind::kBitFlipTrailer, {0, 23}, {168, 191}},
  };
  for (const auto& one : cases) {
    ttf::faults::Fault fault = fault_of(one.kind, 2, 0);
    fault.bits = one.bits;
    Injector injector(plan(fault), cluster_, plant_, 1, 0, nobody_);
    EXPECT_EQ(flipped(left(injector)), one.expected) << ttf::faults::name_of(one.kind);
  }
}

TEST_F(Bytes, DrawnBitsAreAsManyAndDifferentEveryTimeAndWithinTheirPart) {
  const struct {
    FaultKind kind;
    int low, high;
  } cases[] = {{FaultKind::kBitFlipHeader, 0, 39},
               {FaultKind::kBitFlipPayload, 40, 167},
               {FaultKind::kBitFlipTrailer, 168, 191}};
  for (const auto& one : cases)
    for (const int flips : {1, 5, 24}) {
      ttf::faults::Fault fault = fault_of(one.kind, 2, 0);
      fault.flips = flips;
      Injector injector(plan(fault), cluster_, plant_, 1, 0, nobody_);
      std::set<std::vector<int>> seen;
      std::set<int> bits_seen;
      for (int i = 0; i < 400; ++i) {
        plant_.time += Duration{kCycleNs};
        const std::vector<int> bits = flipped(left(injector));
        EXPECT_EQ(bits.size(), static_cast<std::size_t>(flips));
        EXPECT_GE(bits.front(), one.low);
        EXPECT_LE(bits.back(), one.high);
        seen.insert(bits);
        bits_seen.insert(bits.begin(), bits.end());
      }
      if (flips < 24) {
        EXPECT_GT(seen.size(), 20U);
      }
      if (one.kind != FaultKind::kBitFlipPayload) {
        EXPECT_EQ(static_cast<int>(bits_seen.size()), one.high - one.low + 1) << "every bit at some time";
      }
    }
}

TEST_F(Bytes, InvertedBitsFailTheCrcThatCoversThem) {
  const auto says = [&](FaultKind kind, std::vector<int> bits) {
    ttf::faults::Fault fault = fault_of(kind, 2, 0);
    fault.bits = std::move(bits);
    Injector injector(plan(fault), cluster_, plant_, 1, 0, nobody_);
    return bus::wire::decode_frame(Channel::kB, left(injector)).error;
  };
  EXPECT_EQ(says(FaultKind::kBitFlipHeader, {12}), bus::wire::FrameError::kHeaderCrc);  // in the frame id
  EXPECT_EQ(says(FaultKind::kBitFlipHeader, {36}), bus::wire::FrameError::kFrameCrc);   // in the cycle count
  EXPECT_EQ(says(FaultKind::kBitFlipPayload, {64}), bus::wire::FrameError::kFrameCrc);
  EXPECT_EQ(says(FaultKind::kBitFlipTrailer, {7}), bus::wire::FrameError::kFrameCrc);
}

TEST_F(Bytes, AnothersFrameIdHasARightCrc) {
  ttf::faults::Fault fault = fault_of(FaultKind::kMasquerading, 2, 0);
  fault.masquerade = ttf::faults::MasqueradeMode::kOwnSlot;
  fault.slot = 60;
  Injector injector(plan(fault), cluster_, plant_, 1, 0, nobody_);
  const std::vector<std::byte> bytes = left(injector);
  const bus::wire::DecodedFrame decoded = bus::wire::decode_frame(Channel::kB, bytes);
  EXPECT_EQ(decoded.error, bus::wire::FrameError::kNone);
  EXPECT_EQ(decoded.header.frame_id, 60);
  EXPECT_EQ(decoded.header.cycle, 17);
  EXPECT_TRUE(std::equal(decoded.payload.begin(), decoded.payload.end(), frame().begin() + bus::wire::kHeaderBytes));
}

// The frame is on its way to the coupler when the same node babbles: behind the coupler it is still the
// faulty frame.
TEST_F(Bytes, AFaultsSignalIsNotTakenForTheNodesFrame) {
  ttf::faults::Fault fault = fault_of(FaultKind::kBitFlipTrailer, 2, 0);
  fault.bits = {5};
  fault.receivers = {NodeId{1}};
  Injector injector(plan(fault), cluster_, plant_, 1, 0, nobody_);
  EXPECT_TRUE(flipped(left(injector)).empty()) << "at the sender it is in order";
  const auto arrives = [&](NodeId receiver, bool emitted) {
    medium::Arriving signal{NodeId{2},
                            receiver,
                            Channel::kB,
                            bus::ports::Signal::kFrame,
                            plant_.time,
                            plant_.time + Duration{26'300},
                            receiver != kNoNode,
                            frame(),
                            emitted};
    EXPECT_TRUE(injector.arriving(signal));
    return flipped({signal.bytes.begin(), signal.bytes.end()});
  };
  EXPECT_TRUE(arrives(kNoNode, true).empty());
  EXPECT_TRUE(arrives(NodeId{1}, true).empty()) << "what a fault sends is as it made it";
  EXPECT_TRUE(arrives(NodeId{0}, false).empty());
  EXPECT_EQ(arrives(NodeId{1}, false).size(), 1U);
}

TEST_F(Bytes, TimesCountFromTheOrigin) {
  ttf::faults::Fault fault = fault_of(FaultKind::kCrash, 2, 0);
  fault.from = Duration{500};
  fault.duration = Duration{100};
  Injector injector(plan(fault), cluster_, plant_, 1, 0, nobody_, TrueTime{2'000});
  EXPECT_EQ(injector.next(), TrueTime{2'500});
  injector.act(plant_.time = injector.next());
  EXPECT_EQ(injector.next(), TrueTime{2'600});
  injector.act(plant_.time = injector.next());
  EXPECT_EQ(injector.next(), kNever<TrueTime>);
  EXPECT_EQ(plant_.asked, (std::vector<std::string>{"off 2", "on 2 2600"}));
}

TEST_F(Bytes, NothingIsShiftedToBeforeItIsSent) {
  ttf::faults::Fault fault = fault_of(FaultKind::kSosTiming, 2, 0);
  fault.shift = Duration::microseconds(-9);
  ttf::faults::FaultPlan plan{"", {fault, fault, fault, fault}};
  plant_.time = TrueTime{1'000'000};
  Injector injector(plan, cluster_, plant_, 1, 0, nobody_);
  medium::Leaving signal{
      NodeId{2}, Channel::kB, bus::ports::Signal::kFrame, plant_.time, plant_.time + Duration{26'300}, frame()};
  ASSERT_TRUE(injector.leaving(signal));
  EXPECT_EQ(signal.end, plant_.time) << "36 us early would be";
  EXPECT_EQ(signal.end - signal.start, Duration{26'300});
}

// A transient begins in the middle of a frame. A receiver becomes deaf before it begins to receive a frame that
// has left. Both are known when the frame leaves, and reported when the fault begins.
TEST(Injector, NothingIsReportedBeforeItIsSo) {
  const TrueTime slot_three{1'000'000 + 10 * kCycleNs + 2 * 43'000 + 7'000};
  for (const FaultKind kind : {FaultKind::kTransient, FaultKind::kOmission}) {
    ttf::faults::Fault fault = fault_of(kind, 0, 10, 1);
    fault.direction = ttf::faults::FaultDirection::kReceive;
    FaultBusConfig config = six({});
    config.most_drift_ppb = 0;
    // The first instant at which node 2's frame has left without reaching node 0, or is half over.
    FaultBus undisturbed(config);
    undisturbed.simulation().run_until(slot_three - Duration{1'000});
    const medium::FlexRayMedium& medium = undisturbed.simulation().medium();
    const auto carrier = [&] { return medium.carrier(NodeId{0}, Channel::kA, undisturbed.simulation().now()); };
    while (!carrier()) undisturbed.simulation().run_until(undisturbed.simulation().now() + Duration{1});
    const TrueTime received = undisturbed.simulation().now();
    ASSERT_LT(received - slot_three, Duration{10'000});
    ASSERT_GT(medium.delay(NodeId{2}, NodeId{0}), Duration{1});
    const TrueTime from = kind == FaultKind::kOmission ? received : received + Duration{10'000};
    fault.from = from - TrueTime{1'000'000};
    fault.duration = Duration{kCycleNs / 2};
    config.faults = {fault};
    FaultBus bus(config);
    bus.simulation().run_until(from - Duration{1});
    EXPECT_TRUE(bus.activities().empty()) << ttf::faults::name_of(kind);
    EXPECT_EQ(bus.acts(), 0U);
    bus.simulation().run_until(from);
    ASSERT_EQ(bus.activities().size(), 3U) << ttf::faults::name_of(kind);
    EXPECT_EQ(bus.activities()[0].what, recording::records::FaultAct::kBegins);
    for (const FaultBus::Activity& activity : bus.activities()) EXPECT_EQ(activity.at, from);
    EXPECT_NE(bus.activities()[1].text, bus.activities()[2].text) << "on A and on B";
    EXPECT_EQ(bus.acts(), 2U);
    EXPECT_EQ(bus.injector().activations()[0].first, from);
    bus.run(5 * 20);
    EXPECT_EQ(bus.said(0).count(3, bus::controller::kSyntaxError | bus::controller::kNoFrame), 2)
        << "once on each channel";
  }
}

TEST(Injector, L4NothingIsAllocatedWhileItRuns) {
  // Without crash and lone coldstart: power-on makes a new controller.
  std::vector<ttf::faults::Fault> faults;
  for (const ttf::faults::Fault& fault : every_kind())
    if (fault.kind != FaultKind::kCrash && fault.kind != FaultKind::kLoneColdstart) faults.push_back(fault);
  const schedules::model::Cluster cluster = engine::bus_cluster(6, 3, 6);
  const ttf::faults::FaultPlan plan{"", faults};
  const ttf::faults::BelievedSchedules believed(plan, cluster);
  std::vector<engine::BusNode> nodes;
  std::vector<bus::controller::ControllerEvents*> events;
  bus::controller::ControllerEvents silent;
  for (int n = 0; n < 6; ++n) {
    engine::BusNode node{timebase::Oscillator(25'000, 1'000 * n, 0)};
    node.clock = bus::controller::InitialClock{node.oscillator.ticks_at(TrueTime{1'000'000}) + Microticks{1}, 0};
    node.view = believed.of(static_cast<NodeId>(n));
    nodes.push_back(node);
    events.push_back(&silent);
  }
  engine::BusSimulation simulation(cluster, std::move(nodes), std::move(events));
  recording::records::Sink nobody;
  Injector injector(plan, cluster, simulation, 1, 0, nobody, TrueTime{1'000'000});
  simulation.set_disturbance(&injector);
  const std::int64_t before = support::allocations();
  simulation.run_until(TrueTime{130 * kCycleNs});
  EXPECT_EQ(support::allocations() - before, 0);
  for (const Injector::Activation& activation : injector.activations()) EXPECT_GT(activation.times, 0U);
}

TEST(BelievedSchedules, AnImpossibleFaultIsRefusedWhenThePlanIsResolved) {
  const schedules::model::Cluster cluster = engine::bus_cluster(4, 1, 4);
  const auto refused = [&](std::vector<ttf::faults::Fault> faults) -> std::string {
    try {
      ttf::faults::resolve({"drive.yaml", std::move(faults)}, cluster);
    } catch (const InputError& error) {
      EXPECT_EQ(error.findings().size(), 1U);
      return error.findings()[0].sentence();
    }
    return "";
  };
  const auto wrong = [](ttf::faults::WrongSchedule mode, int by) {
    ttf::faults::Fault fault = fault_of(FaultKind::kWrongSchedule, 3, 0);
    fault.wrong = mode;
    fault.by = by;
    fault.line = 5;
    return fault;
  };
  EXPECT_EQ(refused({wrong(ttf::faults::WrongSchedule::kStaticSlot, 6)}), "");
  EXPECT_EQ(refused({wrong(ttf::faults::WrongSchedule::kStaticSlot, 11)}),
            "drive.yaml:5: faults[0].by = 11: must shorten the network idle time by at most 644 macroticks: 64 slots "
            "take 704");
  // Twice six is too much again.
  EXPECT_NE(
      refused({wrong(ttf::faults::WrongSchedule::kStaticSlot, 6), wrong(ttf::faults::WrongSchedule::kStaticSlot, 6)}),
      "");
  EXPECT_EQ(refused({wrong(ttf::faults::WrongSchedule::kPayloadLength, 120)}),
            "drive.yaml:5: faults[0].by = 120: must be at most 119: a static frame has 8 words and room for 127");
  ttf::faults::Fault same = fault_of(FaultKind::kDuplicateColdstart, 0, 0);
  same.duplicate = ttf::faults::DuplicateMode::kSameKeySlot;
  EXPECT_EQ(refused({same}),
            "drive.yaml: faults[0].slot: must be given: there is no other coldstart node whose slot it could take");
  ttf::faults::Fault masquerade = fault_of(FaultKind::kMasquerading, 3, 0);
  masquerade.slot = 4;
  EXPECT_EQ(refused({masquerade}), "drive.yaml: faults[0].slot = 4: must be another's slot of 4 nodes");
}

TEST(ChannelSwap, ANodeWithOneWireIsRefused) {
  schedules::model::Cluster cluster = engine::bus_cluster(4, 2, 4);
  cluster.nodes[3].flexray->pChannels = schedules::model::Channels::kA;
  ttf::faults::Fault fault = fault_of(FaultKind::kChannelSwap, 3, 0);
  fault.line = 7;
  try {
    ttf::faults::resolve({"drive.yaml", {fault_of(FaultKind::kChannelSwap, 2, 0), fault}}, cluster);
    ADD_FAILURE() << "not refused";
  } catch (const InputError& error) {
    ASSERT_EQ(error.findings().size(), 1U);
    EXPECT_EQ(error.findings()[0].sentence(),
              "drive.yaml:7: faults[1].node = node3: must be on both channels of 4 nodes");
  }
}

// A campaign's variant with one channel has no channels to swap.
TEST(ChannelSwap, WhereThereIsOneChannelItDoesNothing) {
  FaultBusConfig config = six({fault_of(FaultKind::kChannelSwap, 3)});
  for (schedules::model::Node& node : config.cluster.nodes) node.flexray->pChannels = schedules::model::Channels::kA;
  for (schedules::model::FrameSlot& frame : config.cluster.frames) frame.channels = schedules::model::Channels::kA;
  FaultBus bus(std::move(config));
  bus.run(5 * 30);
  EXPECT_EQ(bus.acts(), 0U);
  for (int n = 0; n < 6; ++n) EXPECT_TRUE(bus.said(n).problems.empty()) << n;
}

TEST(BelievedSchedules, EachDiffersFromTheClusterInItsOwnWay) {
  const schedules::model::Cluster cluster = engine::bus_cluster(4, 2, 4);
  ttf::faults::Fault fault = fault_of(FaultKind::kWrongSchedule, 3, 0);
  const auto believed = [&](ttf::faults::WrongSchedule mode, int by, int slot = 0) {
    fault.wrong = mode;
    fault.by = by;
    fault.slot = slot;
    schedules::model::Cluster changed = cluster;
    EXPECT_EQ(ttf::faults::believe(fault, changed), "");
    return changed;
  };
  const schedules::model::Cluster shifted = believed(ttf::faults::WrongSchedule::kShiftedSlots, 62);
  EXPECT_EQ(shifted.nodes[3].flexray->pKeySlotId, 2);  // round the end of 64
  EXPECT_TRUE(std::is_sorted(shifted.frames.begin(), shifted.frames.end(),
                             [](const auto& a, const auto& b) { return a.slot < b.slot; }));
  const schedules::model::Cluster longer = believed(ttf::faults::WrongSchedule::kCycleLength, 40);
  EXPECT_EQ(longer.flexray.gMacroPerCycle, 5'040);
  EXPECT_EQ(longer.cycle(), Duration::microseconds(5'040));
  EXPECT_EQ(longer.nodes[3].flexray->pMicroPerCycle, 201'600);
  EXPECT_EQ(longer.nodes[0].flexray->pMicroPerCycle, engine::kMicroPerCycle);
  const schedules::model::Cluster slots = believed(ttf::faults::WrongSchedule::kStaticSlot, 2);
  EXPECT_EQ(slots.flexray.gdStaticSlot, 45);
  EXPECT_EQ(slots.flexray.gdNIT, cluster.flexray.gdNIT - 128);
  EXPECT_EQ(slots.cycle(), cluster.cycle());
  const schedules::model::Cluster key = believed(ttf::faults::WrongSchedule::kKeySlot, 0, 2);
  EXPECT_EQ(key.nodes[3].flexray->pKeySlotId, 2);
  const ttf::faults::BelievedSchedules all({"", {fault}}, cluster);
  EXPECT_EQ(all.of(NodeId{0}), nullptr);
  ASSERT_NE(all.of(NodeId{3}), nullptr);
  EXPECT_EQ(all.of(NodeId{3})->nodes[3].flexray->pKeySlotId, 2);
}

}  // namespace
}  // namespace ttf::sim::faults
