// The message of a turn: it is read as written, and other messages are refused.
#include "sim/processes/turn.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <limits>
#include <stdexcept>
#include <vector>

#include "bus/wire/flexray_frame.h"
#include "tests/sim/drives/drive_fixture.h"

namespace ttf::sim::processes {
namespace {

using schedules::model::Channel;

constexpr nodes::host::Promise kSilent{kNever<Microticks>};

class Turn : public testing::Test {
 protected:
  Turn() {
    host_ = cluster_.sensors.front().host;
    device_ = cluster_.sensors.front().device;
    bus::wire::FrameHeader header;
    header.frame_id = 7;
    frame_.resize(
        bus::wire::encode_frame(header, Channel::kB, std::array<std::byte, 4>{std::byte{1}, std::byte{2}}, frame_));
  }
  std::vector<std::byte> message(const TurnHeader& header, const std::vector<Act>& acts) const {
    TurnWriter writer;
    for (const Act& act : acts) writer.add(act);
    const auto bytes = writer.finish(header);
    return {bytes.begin(), bytes.end()};
  }
  bus::ports::Transmission signal(bus::ports::Signal kind) const {
    return {Channel::kB,
            kind,
            Microticks{4'000},
            Microticks{4'100},
            7,
            kind == bus::ports::Signal::kFrame ? std::span<const std::byte>(frame_) : std::span<const std::byte>(),
            {}};
  }
  std::vector<std::byte> every_kind() const {
    return message({host_, 3, Microticks{4'000}, {Microticks{5'000}, Microticks{1}, Microticks{2}, Microticks{3}}},
                   {signal(bus::ports::Signal::kFrame), signal(bus::ports::Signal::kCas),
                    CanAct{1, {0x123, true, std::span<const std::byte>(frame_).first(8)}}, TriggerAct{SensorId{0}}});
  }

  const schedules::model::Cluster cluster_ =
      schedules::file::load_cluster(sim::drives::shipped("schedules/paper_synchronised.yaml"));
  NodeId host_{}, device_{};
  std::vector<std::byte> frame_ = std::vector<std::byte>(bus::wire::kMaxFrameBytes);
};

TEST_F(Turn, IsReadAsItWasWritten) {
  const std::vector<std::byte> bytes = every_kind();
  std::vector<Act> acts;
  const TurnHeader header = read_turn(cluster_, bytes, acts);
  EXPECT_EQ(header.node, host_);
  EXPECT_EQ(header.number, 3u);
  EXPECT_EQ(header.at, Microticks{4'000});
  EXPECT_EQ(header.promise, (nodes::host::Promise{Microticks{5'000}, Microticks{1}, Microticks{2}, Microticks{3}}));
  ASSERT_EQ(acts.size(), 4u);
  const auto& frame = std::get<bus::ports::Transmission>(acts[0]);
  EXPECT_EQ(frame.channel, Channel::kB);
  EXPECT_EQ(frame.start, Microticks{4'000});
  EXPECT_EQ(frame.end, Microticks{4'100});
  EXPECT_EQ(frame.slot, 7);
  EXPECT_TRUE(std::equal(frame.bytes.begin(), frame.bytes.end(), frame_.begin(), frame_.end()));
  EXPECT_EQ(frame.content.header.frame_id, 7);
  EXPECT_EQ(frame.content.payload.size(), 4u);
  EXPECT_EQ(std::get<bus::ports::Transmission>(acts[1]).signal, bus::ports::Signal::kCas);
  const auto& can = std::get<CanAct>(acts[2]);
  EXPECT_EQ(can.bus, 1u);
  EXPECT_EQ(can.frame.identifier, 0x123u);
  EXPECT_TRUE(can.frame.flexible_data_rate);
  EXPECT_EQ(can.frame.data.size(), 8u);
  EXPECT_EQ(std::get<TriggerAct>(acts[3]).sensor, SensorId{0});

  const std::vector<std::byte> strobe =
      message({device_, 0, Microticks{-1}, kSilent}, {StrobeAct{SensorId{0}, 0xFFFF'FFFE}});
  EXPECT_EQ(read_turn(cluster_, strobe, acts).at, Microticks{-1});
  EXPECT_EQ(std::get<StrobeAct>(acts[0]).sequence, 0xFFFF'FFFEu);
}

TEST_F(Turn, OnlyAnActuatorsNodeActuates) {
  const schedules::model::Cluster loop =
      schedules::file::load_cluster(sim::drives::shipped("schedules/closed_loop_synchronised.yaml"));
  const nodes::host::Actuation actuation{TrueTime{7'000'000}, -3.25, 0.125};
  std::vector<Act> acts;
  const NodeId actuator = *loop.find_node("actuator"), feature = *loop.find_node("feature");
  (void)read_turn(loop, message({actuator, 0, Microticks{5}, kSilent}, {actuation}), acts);
  const auto& read = std::get<nodes::host::Actuation>(acts.at(0));
  EXPECT_EQ(read.from, actuation.from);
  EXPECT_EQ(read.acceleration, actuation.acceleration);
  EXPECT_EQ(read.steering, actuation.steering);
  EXPECT_THROW((void)read_turn(loop, message({feature, 0, Microticks{5}, kSilent}, {actuation}), acts),
               std::runtime_error);
  const nodes::host::Actuation infinite{TrueTime{1}, std::numeric_limits<double>::infinity(), 0.0};
  EXPECT_THROW((void)read_turn(loop, message({actuator, 0, Microticks{5}, kSilent}, {infinite}), acts),
               std::runtime_error);
}

TEST_F(Turn, TheWriterBeginsAnewOnceCleared) {
  TurnWriter writer;
  writer.add(TriggerAct{SensorId{0}});
  EXPECT_FALSE(writer.empty());
  (void)writer.finish({host_, 0, {}, kSilent});
  writer.clear();
  EXPECT_TRUE(writer.empty());
  std::vector<Act> acts;
  (void)read_turn(cluster_, writer.finish({host_, 1, {}, kSilent}), acts);
  EXPECT_TRUE(acts.empty());
}

TEST_F(Turn, IsNotTakenInPart) {
  const std::vector<std::byte> bytes = every_kind();
  std::vector<Act> acts;
  for (std::size_t size = 0; size < bytes.size(); ++size)
    EXPECT_THROW((void)read_turn(cluster_, std::span(bytes).first(size), acts), std::runtime_error) << size;
  std::vector<std::byte> longer = bytes;
  longer.push_back(std::byte{});
  EXPECT_THROW((void)read_turn(cluster_, longer, acts), std::runtime_error);
}

TEST_F(Turn, SaysNothingThatItsNodeCannotDo) {
  std::vector<Act> acts;
  const auto refuses = [&](const TurnHeader& header, const std::vector<Act>& said) {
    EXPECT_THROW((void)read_turn(cluster_, message(header, said), acts), std::runtime_error);
  };
  const TurnHeader header{host_, 0, Microticks{4'000}, kSilent};
  refuses({static_cast<NodeId>(cluster_.nodes.size()), 0, {}, kSilent}, {});
  refuses({host_, 0, Microticks{9}, {Microticks{9}}}, {});  // its turn would never end
  refuses({host_, 0, {}, {Microticks{1}, Microticks{-1}}}, {});
  refuses({host_, 0, {}, {kNever<Microticks> - Microticks{1}}}, {});
  refuses({device_, 0, {}, kSilent}, {TriggerAct{SensorId{0}}});
  refuses(header, {StrobeAct{SensorId{0}, 0}});
  refuses(header, {TriggerAct{static_cast<SensorId>(cluster_.sensors.size())}});
  refuses(header, {CanAct{cluster_.can_buses.size(), {}}});
  refuses(header, {CanAct{0, {0x800, false, {}}}});
  bus::ports::Transmission early = signal(bus::ports::Signal::kFrame);
  early.start = Microticks{3'999};
  refuses(header, {early});
  bus::ports::Transmission backwards = signal(bus::ports::Signal::kCas);
  backwards.end = Microticks{3'999};
  refuses(header, {backwards});
  std::vector<std::byte> damaged = frame_;
  damaged[6] ^= std::byte{1};
  bus::ports::Transmission wrong = signal(bus::ports::Signal::kFrame);
  wrong.bytes = damaged;
  refuses(header, {wrong});
}

}  // namespace
}  // namespace ttf::sim::processes
