#include "bus/cni/cni.h"

#include "core/check.h"

namespace ttf::bus::cni {

using schedules::model::Channel;
using schedules::model::FrameSlot;

Cni::Sent::Sent(const schedules::model::PduLayout& layout) : current(layout), latched(layout) {
  for (auto& channel : carried) channel.resize(static_cast<std::size_t>(layout.max_fragments()));
}

Cni::Cni(const schedules::model::Cluster& cluster, NodeId node)
    : cluster_(cluster), node_(node), sent_(cluster.pdus.size()), received_(cluster.pdus.size()) {
  for (const FrameSlot& slot : cluster.frames) {
    if (slot.pdu == kNoPdu) continue;
    const std::size_t pdu = index_of(slot.pdu);
    if (slot.sender == node) {
      if (!sent_[pdu]) sent_[pdu] = std::make_unique<Sent>(cluster.pdus[pdu]);
    } else if (!received_[pdu]) {
      received_[pdu] = std::make_unique<IncomingList>(cluster.pdus[pdu]);
    }
  }
}

OutgoingList& Cni::outgoing(PduId pdu) {
  TTF_CHECK(sent_[index_of(pdu)] != nullptr, "{} does not send {}", cluster_.node(node_).name, cluster_.pdu(pdu).name);
  return sent_[index_of(pdu)]->current;
}

IncomingList& Cni::incoming(PduId pdu) {
  TTF_CHECK(received_[index_of(pdu)] != nullptr, "{} does not receive {}", cluster_.node(node_).name,
            cluster_.pdu(pdu).name);
  return *received_[index_of(pdu)];
}

Cni::Sent& Cni::latch(const FrameSlot& slot, std::int64_t cycle) {
  Sent& list = *sent_[index_of(slot.pdu)];
  if (list.latched_cycle != cycle) {
    list.latched_cycle = cycle;
    list.latched = list.current;  // same capacity: no allocation
  }
  return list;
}

Cni::Fragment Cni::fetch(const FrameSlot& slot, std::int64_t cycle) {
  if (slot.pdu == kNoPdu) return {};
  Sent& list = latch(slot, cycle);
  Fragment fragment{list.latched.fragment(slot.fragment), list.latched.sequence(), false};
  fragment.last =
      !fragment.payload.empty() && slot.fragment == list.latched.fragments() - 1 && list.completed != fragment.sequence;
  if (fragment.last) list.completed = fragment.sequence;
  return fragment;
}

bool Cni::pending(const FrameSlot& slot, Channel channel, std::int64_t cycle) {
  const Sent& list = latch(slot, cycle);
  return !list.latched.fragment(slot.fragment).empty() &&
         list.carried[index_of(channel)][static_cast<std::size_t>(slot.fragment)] != list.latched.sequence();
}

void Cni::carried(const FrameSlot& slot, Channel channel) {
  Sent& list = *sent_[index_of(slot.pdu)];
  list.carried[index_of(channel)][static_cast<std::size_t>(slot.fragment)] = list.latched.sequence();
}

}  // namespace ttf::bus::cni
