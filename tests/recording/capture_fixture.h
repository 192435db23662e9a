// Captures of a bus that follows its schedule, for tests and for damage.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "bus/wire/flexray_frame.h"
#include "recording/capture/packet.h"
#include "recording/capture/reader.h"
#include "recording/exports/pcapng_writer.h"
#include "schedules/check/checker.h"

namespace ttf::recording {

using schedules::model::Channel;

inline schedules::model::Cluster shipped_cluster(const std::string& name = "paper_synchronised") {
  return schedules::check::load_checked_cluster(TTF_SOURCE_DIR "/schedules/" + name + ".yaml");
}

// One frame on the bus; `packet()` is its form in a capture.
struct BusFrame {
  std::int64_t time_ns = 0;
  Channel channel = Channel::kA;
  bus::wire::FrameHeader header;
  std::vector<std::byte> payload;
  std::uint8_t errors = 0;

  std::string packet() const {
    std::array<std::byte, bus::wire::kMaxFrameBytes> bytes{};
    bus::wire::FrameHeader sound = header;
    sound.startup = header.startup && header.sync;
    const std::size_t size = bus::wire::encode_frame(sound, channel, payload, bytes);
    std::string out;
    capture::CheckedFlexRayFrame frame = capture::check_flexray_frame(channel, std::span(bytes).first(size));
    frame.errors |= errors;
    put_flexray_packet(out, channel, frame);
    return out;
  }
};

inline std::vector<std::byte> scheduled_payload(const schedules::model::Cluster& cluster) {
  return std::vector<std::byte>(static_cast<std::size_t>(2 * cluster.flexray.gPayloadLengthStatic));
}

// The cluster's frames in `cycles` cycles from counter `first_counter` on, by a clock that is `ppm` fast.
inline std::vector<BusFrame> scheduled_frames(const schedules::model::Cluster& cluster, int cycles,
                                              int first_counter = 0, std::int64_t ppm = 0) {
  constexpr std::int64_t kStart = 1'700'000'000'000'000'000;
  std::vector<BusFrame> frames;
  const int counters = cluster.flexray.gCycleCountMax + 1;
  for (int n = 0; n < cycles; ++n) {
    const int counter = (first_counter + n) % counters;
    for (const schedules::model::FrameSlot& slot : cluster.frames) {
      if (counter % slot.repetition != slot.base_cycle) continue;
      for (const Channel channel : {Channel::kA, Channel::kB}) {
        if (!includes(slot.channels, channel)) continue;
        BusFrame frame;
        const std::int64_t macroticks =
            std::int64_t{n} * cluster.flexray.gMacroPerCycle + (slot.slot - 1) * cluster.flexray.gdStaticSlot;
        const std::int64_t passed = macroticks * cluster.flexray.gdMacrotick_ps / 1000;
        frame.time_ns = kStart + passed + passed / 1'000'000 * ppm;
        frame.channel = channel;
        frame.header.frame_id = static_cast<std::uint16_t>(slot.slot);
        frame.header.cycle = static_cast<std::uint8_t>(counter);
        frame.header.sync = frame.header.startup =
            cluster.node(slot.sender).flexray && cluster.node(slot.sender).flexray->pKeySlotId == slot.slot;
        frame.payload = scheduled_payload(cluster);
        frames.push_back(frame);
      }
    }
  }
  return frames;
}

inline std::string capture_bytes(const std::vector<BusFrame>& frames) {
  const exports::CaptureInterface interface { capture::LinkType::kFlexRay, "FlexRay" };
  std::string bytes;
  exports::CaptureWriter writer(bytes, {&interface, 1}, "");
  for (const BusFrame& frame : frames) writer.packet(0, frame.time_ns, frame.packet(), "");
  return bytes;
}

inline capture::Capture capture_of(const std::vector<BusFrame>& frames) {
  return capture::parse_capture(capture_bytes(frames), "bus.pcapng");
}

}  // namespace ttf::recording
