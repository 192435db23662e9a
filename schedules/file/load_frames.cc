#include "schedules/file/load_frames.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "schedules/file/load_instants.h"
#include "schedules/model/limits.h"
#include "schedules/model/repetitions.h"

namespace ttf::schedules::file {
namespace {

class FrameLoader {
 public:
  FrameLoader(const Names& names, model::Cluster& cluster, std::vector<left_out::List>& lists)
      : names_(names), cluster_(cluster), lists_(lists) {}

  void load(YamlMap& map, int entry) {
    model::FrameSlot frame;
    frame.entry = entry;
    frame.line = map.line();
    frame.sender = names_.node(map, "sender");
    const auto slot = map.integer_if("slot", {1, model::kLastSlot});
    frame.slot = static_cast<int>(slot.value_or(1));
    if (const auto channels = map.choice_if("channels", kChannelChoices))
      frame.channels = *channels;
    else
      derive(frame, "channels", std::string(channels_text(frame.channels = channels_of(frame.sender))));
    const bool is_static = !is_dynamic(cluster_.flexray, frame);
    if (map.has("pdu"))
      load_list(map, frame, is_static);
    else
      load_status(map, frame, slot.has_value(), is_static);
  }

  // Gives slots to the status frames without one.
  void finish() {
    for (model::FrameSlot& frame : waiting_) {
      frame.slot = key_slot(frame.sender);
      if (frame.slot == 0 || is_taken(frame.slot, frame.sender)) frame.slot = lowest_free(frame.sender);
      derive(frame, "slot", fmt::format("{}", frame.slot));
      cluster_.frames.push_back(frame);
    }
    model::order(cluster_.frames);
  }

 private:
  void derive(const model::FrameSlot& frame, std::string_view key, std::string value) {
    cluster_.derived.push_back({fmt::format("frames[{}].{}", *frame.entry, key), std::move(value)});
  }

  model::Channels channels_of(NodeId sender) const {
    const bool known = index_of(sender) < cluster_.nodes.size() && cluster_.node(sender).flexray;
    return known ? cluster_.node(sender).flexray->pChannels : model::Channels::kAB;
  }

  // Returns the key slot that the file says; else 0.
  int key_slot(NodeId sender) const {
    const bool known = index_of(sender) < cluster_.nodes.size() && cluster_.node(sender).flexray;
    return known ? cluster_.node(sender).flexray->pKeySlotId : 0;
  }

  // A slot is taken by a frame, and by another node whose key slot it is.
  bool is_taken(int slot, NodeId sender) const {
    for (std::size_t n = 0; n < cluster_.nodes.size(); ++n)
      if (static_cast<NodeId>(n) != sender && key_slot(static_cast<NodeId>(n)) == slot) return true;
    const auto of_list = [&](const left_out::List& list) {
      const bool known = index_of(list.pdu) < cluster_.pdus.size();
      return !list.at.instant && slot >= list.slot &&
             slot < list.slot + (known ? cluster_.pdu(list.pdu).max_fragments() : 1);
    };
    return std::any_of(lists_.begin(), lists_.end(), of_list) ||
           std::any_of(cluster_.frames.begin(), cluster_.frames.end(),
                       [&](const model::FrameSlot& frame) { return frame.slot == slot; });
  }
  int lowest_free(NodeId sender) const {
    int slot = 1;
    while (is_taken(slot, sender)) ++slot;
    return slot;
  }

  void load_status(YamlMap& map, model::FrameSlot& frame, bool has_slot, bool is_static) {
    left_out::Instant absent;
    const std::vector<int> allowed = frame_repetitions(cluster_.flexray);
    // A static one is of every cycle.
    load_multiplexing(map, cluster_.flexray, allowed, nullptr, {is_static, is_static}, absent, frame.base_cycle,
                      frame.repetition);
    if (absent.instant) derive(frame, "base_cycle", "0");
    if (absent.repetition) derive(frame, "repetition", "1");
    frame.payload_bytes = static_cast<int>(map.integer_or("bytes", 0, {0, model::kMostFragmentBytes}, "bytes"));
    if (frame.payload_bytes > 0 && is_static)
      map.fail("bytes", "must not be given in a static slot: its payload has gPayloadLengthStatic words");
    load_preamble(map, frame);
    map.finish();
    if (has_slot)
      cluster_.frames.push_back(frame);
    else
      waiting_.push_back(frame);
  }

  void load_list(YamlMap& map, model::FrameSlot& frame, bool is_static) {
    frame.pdu = names_.pdu(map, "pdu");
    left_out::Instant absent;
    load_multiplexing(map, cluster_.flexray, frame_repetitions(cluster_.flexray), "slot", {is_static, is_static},
                      absent, frame.base_cycle, frame.repetition);
    auto fragments = map.integer_if("fragments", {1, model::kLastStaticSlot});
    frame.fragment = static_cast<int>(map.integer_or("first_fragment", 0, {0, model::kLastStaticSlot - 1}));
    const int step = static_cast<int>(map.integer_or("fragment_step", 1, {1, 2}));
    const int all = index_of(frame.pdu) < cluster_.pdus.size() ? cluster_.pdu(frame.pdu).max_fragments() : 1;
    if (!fragments) {
      fragments = std::max(1, (all - frame.fragment + step - 1) / step);
      derive(frame, "fragments", fmt::format("{}", *fragments));
    }
    load_preamble(map, frame);
    if (absent.instant || absent.repetition) {
      refuse_parts(map);
      if (step == 1 && *fragments != all)
        map.fail("fragments",
                 fmt::format("must be {}, all of the list, where slot, base_cycle or repetition follow", all));
      map.finish();
      lists_.push_back({frame.pdu, frame.sender, frame.channels, frame.base_cycle, frame.repetition, frame.slot, absent,
                        frame.line, frame.entry});
      return;
    }
    if (const int last = is_static ? model::kLastStaticSlot : model::kLastSlot; frame.slot + *fragments - 1 > last) {
      map.fail("fragments", fmt::format("must be at most {}: {} slots end at {}", last - frame.slot + 1,
                                        is_static ? "static" : "dynamic", last));
      fragments = 1;
    }
    map.finish();
    for (std::int64_t f = 0; f < *fragments; ++f) {
      cluster_.frames.push_back(frame);
      ++frame.slot;
      frame.fragment += step;
    }
  }

  static void load_preamble(YamlMap& map, model::FrameSlot& frame) {
    frame.network_management = map.boolean_or("network_management", false);
    if (map.has("message_id")) frame.message_id = static_cast<std::uint16_t>(map.integer("message_id", {0, 65535}));
  }

  // Slots follow for whole lists alone, one behind the other.
  static void refuse_parts(YamlMap& map) {
    for (const char* key : {"first_fragment", "fragment_step", "network_management", "message_id"})
      if (map.has(key)) map.fail(key, "needs a slot, base_cycle and repetition: they follow for whole lists alone");
  }

  const Names& names_;
  model::Cluster& cluster_;
  std::vector<left_out::List>& lists_;
  std::vector<model::FrameSlot> waiting_;  // status frames without a slot
};

}  // namespace

void load_frames(std::vector<YamlMap>& entries, const Names& names, model::Cluster& cluster,
                 std::vector<left_out::List>& lists) {
  FrameLoader loader(names, cluster, lists);
  for (std::size_t i = 0; i < entries.size(); ++i) loader.load(entries[i], static_cast<int>(i));
  loader.finish();
}

}  // namespace ttf::schedules::file
