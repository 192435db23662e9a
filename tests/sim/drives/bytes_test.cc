// Only bytes travel: a receiver has only the frame's content.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "bus/controller/controller.h"
#include "bus/wire/flexray_frame.h"
#include "bus/wire/pdu_codec.h"
#include "nodes/fusion/fusion_host.h"
#include "nodes/host/step.h"
#include "schedules/file/loader.h"
#include "tests/sim/drives/drive_fixture.h"

namespace ttf::sim::drives {
namespace {

// A forger in the medium: changes one signal of an image frame and corrects both CRCs, so that no check can
// see it.
std::vector<std::byte> forged(std::span<const std::byte> frame, schedules::model::Channel channel,
                              const schedules::model::PduLayout& layout, std::size_t signal, double value) {
  const bus::wire::DecodedFrame decoded = bus::wire::decode_frame(channel, frame);
  EXPECT_EQ(decoded.error, bus::wire::FrameError::kNone);
  std::vector<std::byte> payload(decoded.payload.begin(), decoded.payload.end());
  const std::span<std::byte> fragment(payload.data(), static_cast<std::size_t>(layout.fragment_bytes));
  bus::wire::write_element_raw(layout, fragment, 0, signal, bus::wire::to_raw(layout.element[signal], value));
  std::vector<std::byte> bytes(frame.size());
  bus::wire::encode_frame(decoded.header, channel, payload, bytes);
  return bytes;
}

// A controller of the feature node that receives the fusion node's image frames, original or forged.
struct Receiver final : bus::controller::ControllerEvents, bus::ports::FlexRayPort {
  const schedules::model::Cluster& cluster;
  bus::controller::FlexRayController controller;
  explicit Receiver(const schedules::model::Cluster& c)
      : cluster(c), controller(c, *c.find_node("feature"), *this, *this) {
    controller.start_integrated({Microticks{0}, 0});
  }
  void transmit(const bus::ports::Transmission&) override {}
  bool carrier(schedules::model::Channel) const override { return false; }

  // Delivers one frame at its action point in a cycle.
  void receive(int cycle, int slot, schedules::model::Channel channel, std::span<const std::byte> bytes) {
    const schedules::model::GlobalParameters& g = cluster.flexray;
    while (controller.clock()->cycle() < cycle) controller.advance(controller.next_event());
    const Microticks start = controller.clock()->start_of(
        Macroticks{static_cast<std::int64_t>(slot - 1) * g.gdStaticSlot + g.gdActionPointOffset});
    const Microticks end =
        start + Microticks{bus::wire::frame_duration_ps(g, g.gPayloadLengthStatic) / cluster.nodes[0].microtick_ps};
    controller.receive({channel, bus::ports::Signal::kFrame, start, end, bus::wire::decode_frame(channel, bytes)});
  }
};

TEST(Bytes, ChangedPayloadWithValidCrcChangesTheImage) {
  const schedules::model::Cluster cluster = schedules::file::load_cluster(shipped("schedules/paper_synchronised.yaml"));
  const PduId image = *cluster.find_pdu("image");
  const schedules::model::PduLayout& layout = cluster.pdu(image);
  nodes::host::Output out("image", image, layout);
  const std::size_t x = *schedules::model::find_signal(layout.element, "x");
  out.begin(4, 1, GlobalTime{40'000'000});
  out.set(0, x, 31.0);

  const auto slot = std::find_if(cluster.frames.begin(), cluster.frames.end(),
                                 [&](const auto& f) { return f.pdu == image && f.fragment == 0; });
  ASSERT_NE(slot, cluster.frames.end());
  std::array<std::byte, bus::wire::kMaxPayloadBytes> payload{};
  const auto view = out.view();
  std::copy(view.bytes.begin(), view.bytes.end(), payload.begin());
  bus::wire::FrameHeader header;
  header.frame_id = static_cast<std::uint16_t>(slot->slot);
  header.cycle = static_cast<std::uint8_t>(slot->base_cycle);
  std::array<std::byte, bus::wire::kMaxFrameBytes> frame{};
  const std::size_t size = bus::wire::encode_frame(
      header, schedules::model::Channel::kA,
      std::span<const std::byte>(payload).first(2 * static_cast<std::size_t>(cluster.flexray.gPayloadLengthStatic)),
      frame);
  const std::span<const std::byte> honest(frame.data(), size);
  const auto signals = nodes::fusion::bind_image(cluster, layout);

  Receiver true_receiver(cluster), deceived(cluster);
  true_receiver.receive(slot->base_cycle, slot->slot, schedules::model::Channel::kA, honest);
  deceived.receive(slot->base_cycle, slot->slot, schedules::model::Channel::kA,
                   forged(honest, schedules::model::Channel::kA, layout, x, 17.5));
  const auto received = true_receiver.controller.incoming(image).latest();
  const auto forgery = deceived.controller.incoming(image).latest();
  ASSERT_TRUE(received && forgery);
  EXPECT_NEAR(nodes::fusion::decode_image_object(layout, *received, 0, signals).x, 31.0, 0.003);
  EXPECT_NEAR(nodes::fusion::decode_image_object(layout, *forgery, 0, signals).x, 17.5, 0.003);

  // The same change without a correct CRC is not received.
  std::vector<std::byte> broken(honest.begin(), honest.end());
  broken[bus::wire::kHeaderBytes + 10] ^= std::byte{0x10};
  Receiver careful(cluster);
  careful.receive(slot->base_cycle, slot->slot, schedules::model::Channel::kA, broken);
  EXPECT_FALSE(careful.controller.incoming(image).latest().has_value());
}

}  // namespace
}  // namespace ttf::sim::drives
