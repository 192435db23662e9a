#include "schedules/packing/frames.h"

#include <algorithm>
#include <map>
#include <set>
#include <tuple>
#include <utility>

namespace ttf::schedules::packing {
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

namespace {

bool sends(const std::vector<PackedFrame>& frames, int node) {
  return std::any_of(frames.begin(), frames.end(), [&](const PackedFrame& frame) { return frame.node == node; });
}

// Returns the slots that have the same frame of the node in every cycle.
std::set<int> whole_slots(const std::vector<PackedFrame>& frames, int node) {
  std::set<int> slots;
  for (const PackedFrame& frame : frames)
    if (frame.node == node && frame.repetition == 1) slots.insert(frame.number.slot);
  return slots;
}

// Returns the lowest slot that is a whole one in each vehicle of the node.
std::optional<int> common_key_slot(const std::vector<std::vector<PackedFrame>>& vehicles, int node) {
  std::optional<std::set<int>> common;
  for (const std::vector<PackedFrame>& frames : vehicles) {
    if (!sends(frames, node)) continue;
    std::set<int> own = whole_slots(frames, node);
    if (common) std::erase_if(own, [&](int slot) { return !common->contains(slot); });
    common = std::move(own);
  }
  return common && !common->empty() ? std::optional(*common->begin()) : std::nullopt;
}

// Returns the lowest slot that is free in each vehicle of the node.
int free_slot(const std::vector<std::vector<PackedFrame>>& vehicles, int node) {
  std::set<int> taken;
  for (const std::vector<PackedFrame>& frames : vehicles)
    if (sends(frames, node))
      for (const PackedFrame& frame : frames) taken.insert(frame.number.slot);
  int slot = 1;
  while (taken.contains(slot)) ++slot;
  return slot;
}

}  // namespace

std::optional<int> key_slot(const std::vector<PackedFrame>& frames, int node) {
  const std::set<int> slots = whole_slots(frames, node);
  return slots.empty() ? std::nullopt : std::optional(*slots.begin());
}

std::map<int, int> add_key_slots(std::vector<std::vector<PackedFrame>>& vehicles) {
  std::map<int, model::Channels> nodes;
  for (const std::vector<PackedFrame>& frames : vehicles)
    for (const PackedFrame& frame : frames) nodes.emplace(frame.node, frame.number.channels);
  std::map<int, int> key_slots;
  for (const auto& [node, channels] : nodes) {
    std::optional<int> slot = common_key_slot(vehicles, node);
    if (!slot) {
      slot = free_slot(vehicles, node);
      for (std::vector<PackedFrame>& frames : vehicles)
        if (sends(frames, node)) frames.push_back({{*slot, channels}, 0, 1, node, {}});
    }
    key_slots.emplace(node, *slot);
  }
  for (std::vector<PackedFrame>& frames : vehicles)
    std::stable_sort(frames.begin(), frames.end(),
                     [](const PackedFrame& a, const PackedFrame& b) { return a.number.slot < b.number.slot; });
  return key_slots;
}

}  // namespace ttf::schedules::packing
