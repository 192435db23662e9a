// Any CAN frames, in any order, to a channel's receiver. Laws: an outcome is a value, and counted. A complete
// frame equals its sent form, CAN frame by CAN frame, each of which arrived in this order. Only begun frames
// are abandoned.
//
// First byte: channel (bit 0). Then frames, each begun by a byte. Bits 0 and 1 give its source: any bytes as
// a CAN frame; any bytes as a FlexRay frame to send; the same with correct CRCs; an earlier CAN frame. Bit 2
// changes one of its bytes. Bit 3, with the first source, makes a follow-up to send.
#include <algorithm>
#include <array>
#include <vector>

#include "bus/socketcan/flexray_on_can.h"
#include "bus/wire/flexray_crc.h"
#include "core/check.h"
#include "tests/fuzz/harness.h"

namespace {

using namespace ttf;
using bus::socketcan::Outcome;

bool same(const canfd_frame& one, const canfd_frame& other) {
  return one.can_id == other.can_id && one.len == other.len && std::equal(one.data, one.data + one.len, other.data);
}

canfd_frame any_frame(fuzz::Source& source) {
  canfd_frame can{};
  can.can_id = source.take<std::uint16_t>() & 0xfff;
  const auto how = source.take<std::uint8_t>();
  if ((how & 0x0f) == 0) can.can_id |= static_cast<canid_t>(how & 0xe0) << 24;
  can.flags = (how & 0x1f) == 0x10 ? 0 : CANFD_FDF;
  can.len = source.take<std::uint8_t>();
  const auto bytes = source.bytes(std::min<std::size_t>(can.len, CANFD_MAX_DLEN));
  std::transform(bytes.begin(), bytes.end(), can.data, [](std::byte byte) { return static_cast<std::uint8_t>(byte); });
  return can;
}

canfd_frame sent_follow_up(fuzz::Source& source, schedules::model::Channel channel) {
  return bus::socketcan::follow_up_to_can(
      channel, {.slot = 1 + static_cast<int>(source.below(bus::socketcan::kLastSlot)),
                .cycle_counter = static_cast<std::uint8_t>(source.below(64)),
                .late = Duration::nanoseconds(static_cast<std::int32_t>(source.take<std::uint32_t>()))});
}

// Sent as a frame of a drawn slot; with right CRCs by our own encoder.
std::vector<canfd_frame> sent_frame(fuzz::Source& source, schedules::model::Channel channel, bool right) {
  const int slot = 1 + static_cast<int>(source.below(bus::socketcan::kLastSlot));
  const std::size_t size =
      bus::wire::kHeaderBytes + bus::wire::kTrailerBytes + source.below(bus::wire::kMaxPayloadBytes + 1);
  std::vector<std::byte> frame(size);
  const auto bytes = source.bytes(size);
  std::copy(bytes.begin(), bytes.end(), frame.begin());
  if (right) {
    bus::wire::FrameHeader header;
    header.frame_id = static_cast<std::uint16_t>(slot);
    header.cycle = static_cast<std::uint8_t>(frame[4]) & 0x3f;
    const std::vector<std::byte> payload(
        frame.begin() + bus::wire::kHeaderBytes,
        frame.begin() + static_cast<int>(bus::wire::kHeaderBytes + (size - 8) / 2 * 2));
    frame.resize(bus::wire::kMaxFrameBytes);
    frame.resize(bus::wire::encode_frame(header, channel, payload, frame));
  }
  const bus::socketcan::CanFrames can = bus::socketcan::frame_to_can(slot, frame);
  return {can.all().begin(), can.all().end()};
}

class Laws {
 public:
  explicit Laws(schedules::model::Channel channel) : channel_(channel), receiver_(channel) {}

  void arrive(const canfd_frame& can) {
    const bus::socketcan::Arrival arrival = receiver_.arrive(can);
    ++arrivals_;
    std::uint64_t counted = 0;
    for (std::size_t i = 0; i < bus::socketcan::kOutcomes; ++i) counted += receiver_.count(static_cast<Outcome>(i));
    TTF_CHECK(counted == arrivals_, "{} of {} counted", counted, arrivals_);
    TTF_CHECK(!arrival.abandoned || !begun_.empty(), "abandoned though nothing is begun");
    if (arrival.abandoned) begun_.clear();
    if (arrival.outcome == Outcome::kFragment) begun_.push_back(can);
    if (arrival.outcome == Outcome::kComplete) complete(can, arrival);
  }

 private:
  void complete(const canfd_frame& can, const bus::socketcan::Arrival& arrival) {
    if (arrival.follow_up) {  // a begun frame goes on
      TTF_CHECK(same(bus::socketcan::follow_up_to_can(channel_, *arrival.follow_up), can), "another follow-up");
      TTF_CHECK(!arrival.abandoned, "a follow-up ended a frame");
      return;
    }
    if (arrival.signal != bus::ports::Signal::kFrame) {
      TTF_CHECK(same(bus::socketcan::symbol_to_can(channel_, arrival.signal, arrival.duration), can), "another symbol");
      return;
    }
    const bus::socketcan::CanFrames again = bus::socketcan::frame_to_can(arrival.slot, arrival.frame);
    TTF_CHECK(again.count == begun_.size() + 1, "{} CAN frames of {}", again.count, begun_.size() + 1);
    begun_.push_back(can);
    for (std::size_t i = 0; i < again.count; ++i)
      TTF_CHECK(same(again.frames[i], begun_[i]), "CAN frame {} of {} is another", i, again.count);
    begun_.clear();
  }

  schedules::model::Channel channel_;
  bus::socketcan::Reassembly receiver_;
  std::uint64_t arrivals_ = 0;
  std::vector<canfd_frame> begun_;
};

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::Source source(data, size);
  const auto channel =
      (source.take<std::uint8_t>() & 1) != 0 ? schedules::model::Channel::kB : schedules::model::Channel::kA;
  Laws laws(channel);
  std::vector<canfd_frame> seen;
  while (!source.empty()) {
    const auto how = source.take<std::uint8_t>();
    std::vector<canfd_frame> arriving;
    if ((how & 11) == 8)
      arriving = {sent_follow_up(source, channel)};
    else if ((how & 3) == 0)
      arriving = {any_frame(source)};
    else if ((how & 3) != 3)
      arriving = sent_frame(source, channel, (how & 3) == 2);
    else if (!seen.empty())
      arriving = {seen[source.below(seen.size())]};
    if ((how & 4) != 0 && !arriving.empty()) {
      canfd_frame& changed = arriving[source.below(arriving.size())];
      changed.data[source.below(CANFD_MAX_DLEN)] ^= source.take<std::uint8_t>();
    }
    for (const canfd_frame& can : arriving) laws.arrive(can);
    seen.insert(seen.end(), arriving.begin(), arriving.end());
  }
  return 0;
}
