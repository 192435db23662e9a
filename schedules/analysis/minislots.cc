#include "schedules/analysis/minislots.h"

#include <algorithm>

#include "core/int128.h"
#include "schedules/model/wire_times.h"

namespace ttf::schedules::analysis {
namespace {

constexpr int kShortestDts = 1;  // gdBit

// Returns the most minislots of the slots before `frame` on `channel`. Cluster::frames are ordered by slot.
std::int64_t before(const model::Cluster& cluster, const model::FrameSlot& frame, model::Channel channel) {
  const model::GlobalParameters& g = cluster.flexray;
  std::int64_t minislots = frame.slot - g.gNumberOfStaticSlots - 1;  // one each
  std::int64_t longest = 1;
  int slot = 0;
  for (const model::FrameSlot& other : cluster.frames) {
    if (other.slot >= frame.slot) break;
    if (!is_dynamic(g, other) || !includes(other.channels, channel) || !share_a_cycle(other, frame)) continue;
    if (other.slot != slot) longest = 1;
    slot = other.slot;
    const std::int64_t taken = minislots_of(g, dynamic_words(cluster, other));
    minislots += std::max<std::int64_t>(0, taken - longest);
    longest = std::max(longest, taken);
  }
  return minislots;
}

}  // namespace

Macroticks minislot_start(const model::GlobalParameters& g, std::int64_t minislot) {
  return {static_cast<std::int64_t>(g.gNumberOfStaticSlots) * g.gdStaticSlot + action_point_difference(g) +
          (minislot - 1) * g.gdMinislot};
}

int dynamic_words(const model::Cluster& cluster, const model::FrameSlot& frame) {
  return frame.pdu == kNoPdu ? (frame.payload_bytes + 1) / 2
                             : (preamble_bytes(cluster.flexray, frame) + cluster.pdu(frame.pdu).fragment_bytes + 1) / 2;
}

int longest_dynamic_words(const model::Cluster& cluster, NodeId sender) {
  int longest = 0;
  for (const model::FrameSlot& frame : cluster.frames)
    if (frame.sender == sender && is_dynamic(cluster.flexray, frame))
      longest = std::max(longest, dynamic_words(cluster, frame));
  return longest;
}

std::int64_t minislots_of(const model::GlobalParameters& g, int words) {
  const std::int64_t whole =
      model::ceil_div(longest_bits(g, frame_bits(g, words) + kShortestDts), shortest_macroticks(g, g.gdMinislot));
  return whole + 1 + g.gdDynamicSlotIdlePhase;
}

std::int64_t last_start(const model::GlobalParameters& g, int words) {
  return g.gNumberOfMinislots - minislots_of(g, words) + 1;
}

int earliest_turn(const model::GlobalParameters& g, const model::FrameSlot& frame) {
  return frame.slot - g.gNumberOfStaticSlots;
}

std::int64_t latest_turn(const model::Cluster& cluster, const model::FrameSlot& frame) {
  std::int64_t latest = 0;
  for (const model::Channel channel : model::kBothChannels)
    if (includes(frame.channels, channel)) latest = std::max(latest, before(cluster, frame, channel) + 1);
  return latest;
}

bool always_in_time(const model::Cluster& cluster, const model::FrameSlot& frame) {
  const auto& sender = cluster.node(frame.sender).flexray;
  return sender && latest_turn(cluster, frame) <= sender->pLatestTx;
}

}  // namespace ttf::schedules::analysis
