#include "schedules/synthesis/packing/frames.h"

#include <algorithm>
#include <map>
#include <set>
#include <tuple>
#include <utility>

namespace ttf::schedules::synthesis::packing {
namespace {

// The signals of one slot in each cycle.
using Content = std::vector<std::vector<std::size_t>>;

// Splits the cycles c with c mod repetition == base until all those of a frame have the same signals.
void split(const Instance& instance, const Content& content, PackedFrame frame, std::vector<PackedFrame>& frames) {
  const auto first = static_cast<std::size_t>(frame.base_cycle), step = static_cast<std::size_t>(frame.repetition);
  bool same = true;
  for (std::size_t cycle = first; cycle < content.size(); cycle += step)
    same = same && content[cycle] == content[first];
  if (!same) {
    frame.repetition *= 2;
    split(instance, content, frame, frames);
    frame.base_cycle += frame.repetition / 2;
    return split(instance, content, frame, frames);
  }
  frame.signals = content[first];
  if (!frame.signals.empty()) frame.node = instance.signals[frame.signals.front()].node;
  if (!frame.signals.empty() || !instance.shared_slots) frames.push_back(std::move(frame));
}

}  // namespace

std::vector<PackedFrame> frames_of(const Instance& instance, const Assignment& assignment) {
  std::map<std::tuple<int, model::Channels>, Content> slots;
  Order by_bits;
  for (std::size_t i = 0; i < assignment.size(); ++i)
    if (assignment[i]) by_bits.push_back(i);
  std::stable_sort(by_bits.begin(), by_bits.end(),
                   [&](std::size_t a, std::size_t b) { return assignment[a]->offset < assignment[b]->offset; });
  for (const std::size_t i : by_bits) {
    Content& content = slots[{assignment[i]->number.slot, assignment[i]->number.channels}];
    content.resize(static_cast<std::size_t>(instance.cycles));
    for (int cycle = assignment[i]->first_cycle; cycle < instance.cycles; cycle += instance.signals[i].repetition)
      content[static_cast<std::size_t>(cycle)].push_back(i);
  }
  std::vector<PackedFrame> frames;
  for (const auto& [slot, content] : slots) {
    const auto used =
        std::find_if(content.begin(), content.end(), [](const auto& signals) { return !signals.empty(); });
    const PackedFrame whole{{std::get<0>(slot), std::get<1>(slot)}, 0, 1, instance.signals[used->front()].node, {}};
    const std::size_t begin = frames.size();
    split(instance, content, whole, frames);
    std::sort(frames.begin() + static_cast<std::ptrdiff_t>(begin), frames.end(),
              [](const PackedFrame& a, const PackedFrame& b) { return a.base_cycle < b.base_cycle; });
  }
  return frames;
}

std::optional<int> key_slot(const std::vector<PackedFrame>& frames, int node) {
  for (const PackedFrame& frame : frames)
    if (frame.node == node && frame.repetition == 1) return frame.number.slot;
  return std::nullopt;
}

std::vector<PackedFrame> with_key_slots(std::vector<PackedFrame> frames) {
  std::map<int, model::Channels> nodes;
  std::set<int> taken;
  for (const PackedFrame& frame : frames) {
    nodes.emplace(frame.node, frame.number.channels);
    taken.insert(frame.number.slot);
  }
  for (const auto& [node, channels] : nodes) {
    if (key_slot(frames, node)) continue;
    int slot = 1;
    while (!taken.insert(slot).second) ++slot;
    frames.push_back({{slot, channels}, 0, 1, node, {}});
  }
  std::stable_sort(frames.begin(), frames.end(),
                   [](const PackedFrame& a, const PackedFrame& b) { return a.number.slot < b.number.slot; });
  return frames;
}

}  // namespace ttf::schedules::synthesis::packing
