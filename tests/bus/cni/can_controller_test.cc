#include "bus/cni/can_controller.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "tests/bus/layouts.h"

namespace ttf::bus::cni {
namespace {

constexpr PduId kUp{0}, kDown{1};
constexpr NodeId kDevice{0}, kHost{1};

struct SentFrame {
  std::uint32_t identifier;
  bool flexible_data_rate;
  std::vector<std::byte> data;
  ports::CanFrame view() const { return {identifier, flexible_data_rate, data}; }
};

struct Wire final : ports::CanPort {
  std::vector<SentFrame> frames;
  void send(const ports::CanFrame& frame) override {
    frames.push_back({frame.identifier, frame.flexible_data_rate, {frame.data.begin(), frame.data.end()}});
  }
};

// Fragments of 2 + 4 * 2 = 10 bytes: 12 on CAN FD. With three elements each, 8 bytes for classic CAN.
schedules::model::Cluster cluster(bool flexible_data_rate) {
  schedules::model::Cluster made;
  made.nodes.resize(3);
  made.nodes[0].name = "device";
  made.nodes[1].name = "host";
  made.nodes[2].name = "other";
  const int per_fragment = flexible_data_rate ? 4 : 3;
  made.pdus = {list_layout(4, 10, per_fragment), list_layout(4, 10, per_fragment)};
  schedules::model::CanBus bus;
  bus.name = "private";
  bus.flexible_data_rate = flexible_data_rate;
  bus.nominal_bit_rate = 1'000'000;
  bus.data_bit_rate = flexible_data_rate ? 5'000'000 : 1'000'000;
  bus.messages = {{kUp, 0x123, kDevice, {}, 0}, {kDown, 0x100, kHost, {}, 0}};
  made.can_buses = {bus};
  return made;
}

TEST(CanController, AListTravelsAsFramesOfOneIdentifierInOrder) {
  for (const bool flexible : {false, true}) {
    const schedules::model::Cluster c = cluster(flexible);
    Wire wire;
    CanController device(c, kDevice, 0, wire), host(c, kHost, 0, wire);
    MadeList list(c.pdus[0], 5, 10, 1000);
    device.send(kUp, list.view());
    ASSERT_EQ(wire.frames.size(), static_cast<std::size_t>(list.fragments));
    for (int f = 0; f < list.fragments; ++f) {
      const SentFrame& frame = wire.frames[static_cast<std::size_t>(f)];
      EXPECT_EQ(frame.identifier, 0x123u);
      EXPECT_EQ(frame.flexible_data_rate, flexible);
      ASSERT_EQ(frame.data.size(), flexible ? 12u : 8u);
      const auto payload = list.fragment(f);
      EXPECT_TRUE(std::equal(payload.begin(), payload.end(), frame.data.begin()));
      EXPECT_TRUE(std::all_of(frame.data.begin() + c.pdus[0].fragment_bytes, frame.data.end(),
                              [](std::byte byte) { return byte == std::byte{0}; }));
      const auto arrival = host.receive(frame.view());
      ASSERT_TRUE(arrival.has_value());
      EXPECT_EQ(arrival->pdu, kUp);
      EXPECT_EQ(arrival->sequence, 5u);
      EXPECT_EQ(arrival->effect, f == list.fragments - 1 ? ArrivalEffect::kCompleted : ArrivalEffect::kIncomplete);
    }
    const auto latest = host.incoming(kUp).latest();
    ASSERT_TRUE(latest.has_value());
    EXPECT_TRUE(std::equal(latest->bytes.begin(), latest->bytes.end(), list.bytes.begin(), list.bytes.end()));
  }
}

TEST(CanController, AShortListAfterALongOneIsPaddedWithZerosAgain) {
  const schedules::model::Cluster c = cluster(true);
  Wire wire;
  CanController device(c, kDevice, 0, wire);
  MadeList list(c.pdus[0], 1, 1, 0xFFFF);
  device.send(kUp, list.view());
  ASSERT_EQ(wire.frames.size(), 1u);
  EXPECT_EQ(wire.frames[0].data[10], std::byte{0});
  EXPECT_EQ(wire.frames[0].data[11], std::byte{0});
}

TEST(CanController, FramesNotInTheScheduleAreCountedAndIgnored) {
  const schedules::model::Cluster c = cluster(true);
  Wire wire;
  CanController host(c, kHost, 0, wire);
  const std::vector<std::byte> data(12), cut_off(8), longer(16);
  EXPECT_FALSE(host.receive({0x7FF, true, data}).has_value());
  EXPECT_FALSE(host.receive({0x100, true, data}).has_value());  // its own identifier, from somebody else
  EXPECT_EQ(host.refused().foreign, 2u);
  EXPECT_FALSE(host.receive({0x123, true, cut_off}).has_value());
  EXPECT_FALSE(host.receive({0x123, true, {}}).has_value());
  EXPECT_FALSE(host.receive({0x123, true, longer}).has_value());
  EXPECT_EQ(host.refused().length, 3u);
  EXPECT_FALSE(host.receive({0x123, false, data}).has_value());
  EXPECT_EQ(host.refused().format, 1u);
  EXPECT_FALSE(host.incoming(kUp).latest().has_value());
  EXPECT_TRUE(host.receive({0x123, true, data}).has_value());
  EXPECT_EQ(host.refused().foreign + host.refused().length + host.refused().format, 6u);
}

TEST(CanController, AFlexibleDataRateFrameOnAClassicBusIsRefused) {
  const schedules::model::Cluster c = cluster(false);
  Wire wire;
  CanController device(c, kDevice, 0, wire), host(c, kHost, 0, wire);
  MadeList list(c.pdus[0], 1, 1, 7);
  device.send(kUp, list.view());
  ASSERT_EQ(wire.frames.size(), 1u);
  wire.frames[0].flexible_data_rate = true;
  EXPECT_FALSE(host.receive(wire.frames[0].view()).has_value());
  EXPECT_EQ(host.refused().format, 1u);
  wire.frames[0].flexible_data_rate = false;
  EXPECT_EQ(host.receive(wire.frames[0].view())->effect, ArrivalEffect::kCompleted);
}

// Frames leave some lists after they were queued; the field has four bits.
TEST(CanController, ASentFrameIsOfTheNewestListWithItsNumber) {
  const schedules::model::Cluster c = cluster(true);
  Wire wire;
  CanController device(c, kDevice, 0, wire);
  for (std::uint32_t sequence = 0; sequence < 100; ++sequence) {
    device.send(kUp, MadeList(c.pdus[0], sequence, 1, 0).view());
    for (std::uint32_t behind = 0; behind < std::min(16u, sequence + 1); ++behind)
      ASSERT_EQ(device.sent_sequence(kUp, (sequence - behind) & 15u), sequence - behind);
  }
}

TEST(CanController, ArrivalNamesTheListOfItsFragment) {
  const schedules::model::Cluster c = cluster(true);
  Wire wire;
  CanController device(c, kDevice, 0, wire), host(c, kHost, 0, wire);
  MadeList first(c.pdus[0], 1, 1, 0), second(c.pdus[0], 2, 8, 0), third(c.pdus[0], 3, 8, 0);
  for (const MadeList* list : {&first, &second, &third}) device.send(kUp, list->view());
  ASSERT_EQ(wire.frames.size(), 5u);  // 1 + 2 + 2
  EXPECT_EQ(host.receive(wire.frames[0].view())->sequence, 1u);
  EXPECT_EQ(host.receive(wire.frames[1].view())->sequence, 2u);
  const auto repeated = host.receive(wire.frames[0].view());
  EXPECT_EQ(repeated->effect, ArrivalEffect::kDuplicate);
  EXPECT_EQ(repeated->sequence, 1u);
  const auto torn = host.receive(wire.frames[3].view());
  EXPECT_EQ(torn->effect, ArrivalEffect::kTorn);
  EXPECT_EQ(torn->sequence, 3u);
  EXPECT_EQ(torn->torn, 2u);
  EXPECT_FALSE(host.receive(wire.frames[4].view())->torn.has_value());
}

TEST(CanControllerDeathTest, ListsOfOthersAreOurBugs) {
  const schedules::model::Cluster c = cluster(true);
  Wire wire;
  CanController device(c, kDevice, 0, wire);
  MadeList list(c.pdus[1], 1, 1, 0);
  EXPECT_DEATH(device.send(kDown, list.view()), "does not send");
  EXPECT_DEATH(device.incoming(kUp), "does not receive");
  MadeList cut(c.pdus[0], 1, 10, 0);
  EXPECT_DEATH(device.send(kUp, {1, cut.fragments, std::span(cut.bytes).first(cut.bytes.size() - 1)}), "bytes in");
}

}  // namespace
}  // namespace ttf::bus::cni
