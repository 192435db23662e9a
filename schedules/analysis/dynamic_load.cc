#include "schedules/analysis/dynamic_load.h"

#include <fmt/format.h>

#include <algorithm>

#include "schedules/analysis/minislots.h"

namespace ttf::schedules::analysis {

std::vector<DynamicLoad> dynamic_load(const model::Cluster& cluster) {
  const model::GlobalParameters& g = cluster.flexray;
  std::vector<DynamicLoad> loads;
  for (const model::Channel channel : model::kBothChannels) {
    DynamicLoad load;
    load.channel = channel;
    for (model::FrameSlot frame : cluster.frames) {
      if (!is_dynamic(g, frame) || !includes(frame.channels, channel)) continue;
      frame.channels = channel == model::Channel::kA ? model::Channels::kA : model::Channels::kB;
      const std::int64_t end = latest_turn(cluster, frame) - 1 + minislots_of(g, dynamic_words(cluster, frame));
      load.minislots = std::max(load.minislots, end);
    }
    if (load.minislots > 0) load.share = static_cast<double>(load.minislots) / g.gNumberOfMinislots;
    loads.push_back(load);
  }
  return loads;
}

std::vector<DynamicList> dynamic_lists(const model::Cluster& cluster) {
  const model::GlobalParameters& g = cluster.flexray;
  std::vector<DynamicList> lists;
  for (std::size_t i = 0; i < cluster.frames.size(); ++i) {
    const model::FrameSlot& frame = cluster.frames[i];
    if (!is_dynamic(g, frame)) continue;
    if (i == 0 || !is_dynamic(g, cluster.frames[i - 1]) || !continues(cluster.frames[i - 1], frame)) {
      DynamicList& fresh = lists.emplace_back();
      fresh.pdu = frame.pdu;
      fresh.sender = frame.sender;
      fresh.channels = frame.channels;
      fresh.first_slot = frame.slot;
      fresh.first_fragment = frame.fragment;
      fresh.base_cycle = frame.base_cycle;
      fresh.repetition = frame.repetition;
      fresh.minislots_each = minislots_of(g, dynamic_words(cluster, frame));
      fresh.earliest_turn = earliest_turn(g, frame);
    }
    DynamicList& list = lists.back();
    list.last_slot = frame.slot;
    list.last_fragment = frame.fragment;
    list.latest_turn = std::max(list.latest_turn, latest_turn(cluster, frame));
    list.always_in_time &= always_in_time(cluster, frame);
  }
  return lists;
}

std::string dynamic_text(const model::Cluster& cluster) {
  const auto lists = dynamic_lists(cluster);
  if (lists.empty()) return "";
  const model::GlobalParameters& g = cluster.flexray;
  std::string text = fmt::format("dynamic segment: {} minislots of {} macroticks\nwith every slot in use",
                                 g.gNumberOfMinislots, g.gdMinislot);
  for (const DynamicLoad& load : dynamic_load(cluster))
    text += fmt::format("{} {} takes {} ({:.1f} %)", load.channel == model::Channel::kA ? "" : ",",
                        letter(load.channel), load.minislots, 100.0 * load.share);
  text += fmt::format("\n{:>9}  {:<2}  {:<12}{:<24}{:>15}  {}\n", "slot", "ch", "sender", "list", "minislots each",
                      "turn in minislot");
  for (const DynamicList& list : lists) {
    const bool one = list.first_slot == list.last_slot;
    text += fmt::format(
        "{:>9}  {:<2}  {:<12}{:<24}{:>15}  {}-{}{}\n",
        one ? fmt::format("{}", list.first_slot) : fmt::format("{}-{}", list.first_slot, list.last_slot),
        channels_text(list.channels), cluster.node(list.sender).name,
        list.pdu == kNoPdu ? "frame"
                           : fmt::format("{} {}{}", cluster.pdu(list.pdu).name, list.first_fragment,
                                         one ? "" : fmt::format("-{}", list.last_fragment)),
        list.minislots_each, list.earliest_turn, list.latest_turn, list.always_in_time ? "" : ", or in a later cycle");
  }
  return text;
}

}  // namespace ttf::schedules::analysis
