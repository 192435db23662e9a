#include "bus/socketcan/schedule_on_can.h"

#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include "bus/socketcan/flexray_on_can.h"
#include "bus/wire/flexray_frame.h"
#include "core/int128.h"
#include "schedules/analysis/can_load.h"
#include "schedules/analysis/minislots.h"
#include "schedules/check/real_time_rules.h"

namespace ttf::bus::socketcan {
namespace {

// Returns a valid frame of that slot and length. Its content does not matter: stuff bits are counted for the
// worst case.
CanFrames mapped(int slot, int words) {
  wire::FrameHeader header;
  header.frame_id = static_cast<std::uint16_t>(slot);
  std::array<std::byte, wire::kMaxFrameBytes> bytes{};
  const std::array<std::byte, wire::kMaxPayloadBytes> payload{};
  const std::size_t length = wire::encode_frame(header, schedules::model::Channel::kA,
                                                std::span(payload).first(2 * static_cast<std::size_t>(words)), bytes);
  return frame_to_can(slot, std::span(bytes).first(length));
}

bool is_sync_frame(const schedules::model::Cluster& cluster, const schedules::model::FrameSlot& frame) {
  const auto& sender = cluster.node(frame.sender).flexray;
  return sender && sender->pKeySlotId == frame.slot && sender->pKeySlotUsedForSync;
}

}  // namespace

bool SlotOnCan::holds(std::int64_t time_scale_ppm) const {
  return needs <= schedules::check::stretched(has, time_scale_ppm);
}

std::vector<SlotOnCan> slots_on_can(const schedules::model::Cluster& cluster, BitRates rates) {
  const schedules::model::GlobalParameters& g = cluster.flexray;
  schedules::model::CanBus bus;
  bus.name = "medium";
  bus.flexible_data_rate = true;
  bus.nominal_bit_rate = rates.nominal;
  bus.data_bit_rate = rates.data;
  const Duration follow_up =
      schedules::analysis::can_worst_case(bus, follow_up_to_can(schedules::model::Channel::kA, {1, 0, {}}).len);
  std::map<std::pair<int, Duration>, SlotOnCan> slots;
  for (const schedules::model::FrameSlot& frame : cluster.frames) {
    const bool dynamic = schedules::model::is_dynamic(g, frame);
    const int words = dynamic ? schedules::analysis::dynamic_words(cluster, frame) : g.gPayloadLengthStatic;
    const std::int64_t macroticks =
        dynamic ? schedules::analysis::minislots_of(g, words) * g.gdMinislot : g.gdStaticSlot;
    const CanFrames cans = mapped(frame.slot, words);
    SlotOnCan one{frame.slot,
                  frame.channels,
                  dynamic,
                  static_cast<int>(cans.count),
                  {},
                  {},
                  {macroticks * g.gdMacrotick_ps / 1'000}};
    for (const canfd_frame& can : cans.all()) one.frame += schedules::analysis::can_worst_case(bus, can.len);
    one.needs = one.frame;
    if (is_sync_frame(cluster, frame)) {
      one.needs += follow_up;
      ++one.can_frames;
    }
    const auto [at, fresh] = slots.emplace(std::pair{one.slot, one.has}, one);
    if (fresh) continue;
    SlotOnCan& other = at->second;
    other.channels = static_cast<schedules::model::Channels>(static_cast<unsigned>(other.channels) |
                                                             static_cast<unsigned>(one.channels));
    other.can_frames = std::max(other.can_frames, one.can_frames);
    other.frame = std::max(other.frame, one.frame);
    other.needs = std::max(other.needs, one.needs);
  }
  std::vector<SlotOnCan> list;
  for (const auto& [key, slot] : slots) list.push_back(slot);
  return list;
}

std::int64_t smallest_time_scale(const std::vector<SlotOnCan>& slots) {
  Int128 smallest = schedules::check::kSmallestTimeScale;
  for (const SlotOnCan& slot : slots)
    smallest =
        std::max(smallest, (static_cast<Int128>(slot.needs.ns) * schedules::check::kTimeScaleOne + slot.has.ns - 1) /
                               slot.has.ns);
  return static_cast<std::int64_t>(smallest);
}

}  // namespace ttf::bus::socketcan
