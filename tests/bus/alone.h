// A single controller, and frames made for it.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "bus/wire/flexray_crc.h"
#include "bus/wire/flexray_frame.h"
#include "tests/bus/bus_rig.h"

namespace ttf::bus {

using schedules::model::Channel;

struct NoPort final : ports::FlexRayPort {
  void transmit(const ports::Transmission& transmission) override {
    sent.push_back({transmission.channel, transmission.signal, transmission.start, transmission.end});
  }
  bool carrier(Channel channel) const override { return busy[index_of(channel)]; }

  struct Sent {
    Channel channel;
    ports::Signal signal;
    Microticks start, end;
  };
  std::vector<Sent> sent;
  std::array<bool, 2> busy{};
};

// A frame as the medium hands it over.
inline ports::Reception received(Channel channel, Microticks start, Microticks end, std::span<const std::byte> bytes) {
  return {channel, ports::Signal::kFrame, start, end, wire::decode_frame(channel, bytes)};
}

// Cycle 0 starts at microtick 1000, so macrotick m of cycle c is at 1000 + 40 * (1000 c + m).
struct Alone {
  schedules::model::Cluster cluster;
  NoPort port;
  Reports reports;
  controller::FlexRayController controller;

  explicit Alone(int node = 0, schedules::model::Cluster made = small_cluster(4))
      : cluster(std::move(made)), controller(cluster, static_cast<NodeId>(node), port, reports) {
    controller.start_integrated({{1000}, 0});
  }

  static Microticks at(std::int64_t cycle, std::int64_t macrotick) { return {1000 + 40 * (1000 * cycle + macrotick)}; }
  void run_to(std::int64_t cycle, std::int64_t macrotick = 0) { controller.advance(at(cycle, macrotick)); }
  std::vector<Reports::Sent> sent_in(std::int64_t cycle) const {
    std::vector<Reports::Sent> frames;
    for (const auto& sent : reports.sent)
      if (sent.cycle == cycle) frames.push_back(sent);
    return frames;
  }
};

// A frame from another node, arriving in cycle 0 or later of an Alone.
struct Frame {
  wire::FrameHeader header;
  Channel channel = Channel::kA;
  std::vector<std::byte> payload = std::vector<std::byte>(16);
  std::int64_t start = 0;      // microtick of arrival
  std::int64_t length = 1000;  // in microticks

  static Frame status(int slot, std::int64_t cycle, Channel channel = Channel::kA) {
    Frame frame;
    frame.header.frame_id = static_cast<std::uint16_t>(slot);
    frame.header.cycle = static_cast<std::uint8_t>(cycle % 64);
    frame.header.sync = frame.header.startup = slot <= 4;
    frame.channel = channel;
    frame.start = Alone::at(cycle, 84 * (slot - 1) + 7).value;
    return frame;
  }
  std::vector<std::byte> bytes() const {
    std::vector<std::byte> made(wire::kMaxFrameBytes);
    if (!header.startup || header.sync) {
      made.resize(wire::encode_frame(header, channel, payload, made));
      return made;
    }
    // A startup frame that is no sync frame. encode_frame refuses it, so the two CRCs are put in by hand.
    wire::FrameHeader sync = header;
    sync.sync = true;
    made.resize(wire::encode_frame(sync, channel, payload, made));
    const std::uint32_t crc =
        wire::header_crc(false, true, header.frame_id, static_cast<std::uint8_t>(payload.size() / 2));
    made[0] &= std::byte{0xEF};
    made[2] = (made[2] & std::byte{0xFE}) | static_cast<std::byte>(crc >> 10);
    made[3] = static_cast<std::byte>((crc >> 2) & 0xFF);
    made[4] = static_cast<std::byte>((crc & 3) << 6) | (made[4] & std::byte{0x3F});
    const std::uint32_t trailer = wire::frame_crc(channel, std::span(made).first(made.size() - 3));
    for (std::size_t i = 0; i < 3; ++i)
      made[made.size() - 3 + i] = static_cast<std::byte>((trailer >> (16 - 8 * i)) & 0xFF);
    return made;
  }
  void arrive(Alone& alone) const {
    const auto wire_bytes = bytes();
    alone.controller.advance({start + length - 1});
    alone.controller.receive(received(channel, {start}, {start + length}, wire_bytes));
  }
};

}  // namespace ttf::bus
