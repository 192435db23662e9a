// The checker's rules about the owners of slots and the messages of private CANs.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

#include "schedules/analysis/can_load.h"
#include "schedules/check/checker.h"
#include "schedules/model/limits.h"

namespace ttf::schedules::check {
namespace {

// The frames of one list in the cycles of one base and repetition, ordered by slot.
using Group = std::vector<const model::FrameSlot*>;
using Groups = std::map<std::pair<int, int>, Group>;

std::string cycles_text(const model::FrameSlot& frame) {
  return fmt::format("base cycle {}, repetition {}", frame.base_cycle, frame.repetition);
}

// Checks that each fragment is sent once, in ascending order, and a list once in a cycle: the last fragment then
// leaves last. A slot may carry the same fragment on both channels. It may also carry two of them, the smaller
// first, for a list split between the channels.
void check_order(const model::PduLayout& layout, const Groups& groups, ClusterFindings& findings) {
  const auto wrong = [&](const model::FrameSlot& frame, const std::string& expected) {
    findings.at(frame.line, frame_path(frame), fmt::format("{}, fragment {}", layout.name, frame.fragment), expected);
  };
  for (auto group = groups.begin(); group != groups.end(); ++group) {
    const Group& frames = group->second;
    for (std::size_t i = 1; i < frames.size(); ++i) {
      const model::FrameSlot &before = *frames[i - 1], &frame = *frames[i];
      // A file may list one slot channel by channel.
      const bool repeated = frame.slot == before.slot && frame.fragment == before.fragment;
      if (repeated || frame.fragment > before.fragment) continue;
      wrong(frame,
            fmt::format("must be above fragment {} of slot {} ({}): a list's fragments are sent once each and in "
                        "ascending order",
                        before.fragment, before.slot, place_text(findings.cluster(), before.line)));
      break;
    }
    for (auto other = groups.begin(); other != group; ++other) {
      const model::FrameSlot &frame = *frames.front(), &earlier = *other->second.front();
      if (!share_a_cycle(earlier, frame)) continue;
      wrong(frame, fmt::format("is sent twice in some of the same cycles: slot {} begins the list too ({}; {})",
                               earlier.slot, cycles_text(earlier), place_text(findings.cluster(), earlier.line)));
      break;
    }
  }
}

void check_list(const model::Cluster& cluster, PduId pdu, ClusterFindings& findings) {
  const model::PduLayout& layout = cluster.pdu(pdu);
  Groups groups;
  const NodeId* sender = nullptr;
  const model::FrameSlot* first = nullptr;
  for (const model::FrameSlot& frame : cluster.frames) {
    if (frame.pdu != pdu) continue;
    const std::string key = frame_path(frame);
    if (frame.fragment >= layout.max_fragments())
      findings.at(frame.line, key, fmt::format("fragment {}", frame.fragment),
                  fmt::format("must be 0..{}: {} has {} fragments", layout.max_fragments() - 1, layout.name,
                              layout.max_fragments()));
    if (sender && *sender != frame.sender)
      findings.at(
          frame.line, key, cluster.node(frame.sender).name,
          fmt::format("must be {}: all fragments of {} have one sender", cluster.node(*sender).name, layout.name));
    if (!sender) sender = &frame.sender;
    if (first == nullptr) first = &frame;
    if (is_dynamic(cluster.flexray, frame) && !is_dynamic(cluster.flexray, *first))
      findings.at(frame.line, key, fmt::format("{}", frame.slot),
                  fmt::format("must be 1..{} (gNumberOfStaticSlots) as slot {} is: a list is sent in one segment",
                              cluster.flexray.gNumberOfStaticSlots, first->slot));
    groups[{frame.base_cycle, frame.repetition}].push_back(&frame);
  }
  check_order(layout, groups, findings);
  for (const auto& [cycles, frames] : groups) {
    std::set<int> fragments;
    for (const model::FrameSlot* frame : frames) fragments.insert(frame->fragment);
    for (int f = 0; f < layout.max_fragments(); ++f)
      if (!fragments.contains(f)) {
        findings.at(first->line, frame_path(*first), layout.name,
                    fmt::format("must have a slot for each of the {} fragments in the same cycles: fragment {} has no "
                                "slot in base cycle {}, repetition {}",
                                layout.max_fragments(), f, cycles.first, cycles.second));
        break;
      }
  }
}

// Checks that the slot exists and meets the demands of its segment.
void check_segment(const model::Cluster& cluster, const model::FrameSlot& frame, const std::string& key,
                   ClusterFindings& findings) {
  const model::GlobalParameters& g = cluster.flexray;
  if (frame.slot > g.gNumberOfStaticSlots + g.gNumberOfMinislots)
    findings.at(frame.line, key, fmt::format("{}", frame.slot),
                g.gNumberOfMinislots == 0
                    ? fmt::format("must be 1..{} (gNumberOfStaticSlots)", g.gNumberOfStaticSlots)
                    : fmt::format("must be 1..{} (gNumberOfStaticSlots and a dynamic one per minislot)",
                                  g.gNumberOfStaticSlots + g.gNumberOfMinislots));
  else if (is_dynamic(g, frame) && frame.pdu == kNoPdu && cluster.describes_tasks())
    findings.at(
        frame.line, key, cluster.node(frame.sender).name,
        fmt::format("needs a PDU in the dynamic segment (slots above {}): a frame without a PDU would never be sent",
                    g.gNumberOfStaticSlots));
}

// Checks that the payload has room for the fragment, after any network management vector.
void check_payload(const model::Cluster& cluster, const model::FrameSlot& frame, const std::string& key,
                   ClusterFindings& findings) {
  const model::GlobalParameters& g = cluster.flexray;
  if (is_dynamic(g, frame)) {
    if (frame.network_management)
      findings.at(frame.line, key, "network_management: true",
                  fmt::format("needs a static slot, 1..{} (gNumberOfStaticSlots)", g.gNumberOfStaticSlots));
    const int most = model::kMostFragmentBytes - (frame.message_id ? model::kMessageIdBytes : 0);
    if (frame.pdu != kNoPdu && cluster.pdu(frame.pdu).fragment_bytes > most)
      findings.at(frame.line, key,
                  fmt::format("{} ({} bytes)", cluster.pdu(frame.pdu).name, cluster.pdu(frame.pdu).fragment_bytes),
                  fmt::format("must have at most {} bytes behind its message id", most));
    return;  // a dynamic frame is as long as its fragment
  }
  if (frame.message_id)
    findings.at(frame.line, key, fmt::format("message_id: {}", *frame.message_id),
                fmt::format("needs a dynamic slot, above {} (gNumberOfStaticSlots)", g.gNumberOfStaticSlots));
  const int payload = 2 * g.gPayloadLengthStatic;
  const model::PduLayout* layout = frame.pdu != kNoPdu ? &cluster.pdu(frame.pdu) : nullptr;
  const int fragment = layout != nullptr ? layout->fragment_bytes : 0;
  if (fragment > payload)
    findings.at(frame.line, key, fmt::format("{} ({} bytes)", layout->name, fragment),
                fmt::format("must fit the payload of {} bytes (gPayloadLengthStatic)", payload));
  if (!frame.network_management) return;
  const int vector = g.gNetworkManagementVectorLength;
  if (vector == 0)
    findings.at(frame.line, key, "network_management: true",
                "needs a network management vector: gNetworkManagementVectorLength is 0");
  else if (fragment <= payload && vector + fragment > payload)
    findings.at(frame.line, key, fmt::format("network_management: true ({} bytes)", vector + fragment),
                fmt::format("must fit the payload of {} bytes (gPayloadLengthStatic): the vector's {} bytes and the "
                            "fragment's {}",
                            payload, vector, fragment));
}

}  // namespace

void check_slots(const model::Cluster& cluster, ClusterFindings& findings) {
  std::set<PduId> lists;
  for (std::size_t i = 0; i < cluster.frames.size(); ++i) {
    const model::FrameSlot& frame = cluster.frames[i];
    const std::string key = frame_path(frame);
    const model::Node& sender = cluster.node(frame.sender);
    check_segment(cluster, frame, key, findings);
    if (!sender.flexray)
      findings.at(frame.line, key, sender.name, "must be a node with a FlexRay controller");
    else if ((static_cast<unsigned>(frame.channels) & ~static_cast<unsigned>(sender.flexray->pChannels)) != 0)
      findings.at(frame.line, key, fmt::format("{} on {}", sender.name, channels_text(frame.channels)),
                  fmt::format("must be sent on {} only: {} is not attached to more (pChannels)",
                              channels_text(sender.flexray->pChannels), sender.name));
    if (frame.pdu != kNoPdu) lists.insert(frame.pdu);
    check_payload(cluster, frame, key, findings);
    // Frames are ordered by slot, so other frames of this slot stand right before it. One conflict per frame is
    // reported.
    for (std::size_t j = i; j-- > 0 && cluster.frames[j].slot == frame.slot;) {
      const model::FrameSlot& other = cluster.frames[j];
      if (!share_a_channel(other.channels, frame.channels) || !share_a_cycle(other, frame)) continue;
      findings.at(
          frame.line, key, fmt::format("{} on {}", sender.name, channels_text(frame.channels)),
          fmt::format("is owned twice: {} on {} sends there in some of the same cycles (base {}, repetition {}; "
                      "{})",
                      cluster.node(other.sender).name, channels_text(other.channels), other.base_cycle,
                      other.repetition, place_text(cluster, other.line)));
      break;
    }
  }
  for (const PduId pdu : lists) check_list(cluster, pdu, findings);
}

void check_can(const model::Cluster& cluster, ClusterFindings& findings) {
  for (const model::CanBus& bus : cluster.can_buses) {
    const std::string path = "can." + bus.name;
    bool all_fit = true;
    std::set<std::uint32_t> identifiers;
    std::set<PduId> pdus;
    for (const model::CanMessage& message : bus.messages) {
      const model::PduLayout& layout = cluster.pdu(message.pdu);
      const std::string key = message_path(bus, message);
      if (!analysis::can_data_length(bus.flexible_data_rate, layout.fragment_bytes)) {
        all_fit = false;
        findings.at(message.line, key, fmt::format("{} bytes", layout.fragment_bytes),
                    fmt::format("must fit a frame of this CAN, at most {} bytes", bus.flexible_data_rate ? 64 : 8));
      }
      if (!identifiers.insert(message.identifier).second)
        findings.at(message.line, key, fmt::format("identifier {}", message.identifier),
                    "must be unique on its CAN: arbitration needs it");
      if (!pdus.insert(message.pdu).second)
        findings.at(message.line, key, layout.name, "must be sent by one message of its CAN only");
    }
    if (!all_fit) continue;  // without lengths the load is unknown
    const double load = analysis::can_worst_load(cluster, bus);
    if (load > analysis::kCanLoadLimit) {
      findings.at(bus.line, path, fmt::format("worst-case load {:.1f} %", 100.0 * load),
                  fmt::format("must be at most {:.0f} %, other_load included", 100.0 * analysis::kCanLoadLimit));
      continue;  // responses may have no bound
    }
    for (const model::CanMessage& message : bus.messages) {
      // The response is a bound only if no second list of the message is queued while the first is on its way, or the
      // bus is not idle yet behind it.
      const auto response = analysis::can_worst_response(cluster, bus, message);
      const auto until_idle = response ? std::optional(*response + analysis::can_after_acceptance(bus)) : std::nullopt;
      if (until_idle && *until_idle > message.shortest_period)
        findings.at(
            message.line, message_path(bus, message) + ".shortest_period", ms(message.shortest_period),
            fmt::format("must be at least {}: from queueing a full list to its last frame's end", ms(*until_idle)));
    }
  }
}

}  // namespace ttf::schedules::check
