// A small cluster with a dynamic segment.
#pragma once

#include <vector>

#include "tests/bus/bus_rig.h"

namespace ttf::bus {

using schedules::model::Channel;

inline constexpr std::int64_t kSegment =
    840 + 4;  // macrotick of the first minislot: 10 static slots, difference of action points

// small_cluster with 24 minislots of 5 MT; dynamic slot 11 + n is node n's, one fragment of 8 bytes.
inline schedules::model::Cluster dynamic_cluster(
    int nodes, schedules::model::Channels channels = schedules::model::Channels::kAB) {
  schedules::model::Cluster cluster = small_cluster(nodes);
  cluster.flexray.gNumberOfMinislots = 24;
  cluster.flexray.gdNIT = 1000 - kSegment - 24 * 5;
  cluster.flexray.gOffsetCorrectionStart = 980;
  for (int n = 0; n < nodes; ++n) {
    cluster.nodes[static_cast<std::size_t>(n)].flexray->pLatestTx = 15;
    cluster.pdus.push_back(list_layout(4, 3, 3));
    cluster.frames.push_back({11 + n, channels, 0, 1, static_cast<NodeId>(n), static_cast<PduId>(2 + n), 0, 0});
  }
  return cluster;
}

inline void write(Rig& rig, std::size_t node, std::uint32_t sequence) {
  const MadeList list(rig.cluster().pdus[2 + node], sequence, 3, 0);
  rig.controller(node).outgoing(static_cast<PduId>(2 + node)).write(list.view());
}

inline std::vector<Reports::Sent> dynamic_frames(Rig& rig, std::size_t node, Channel channel = Channel::kA) {
  std::vector<Reports::Sent> frames;
  for (const auto& sent : rig.reports(node).sent)
    if (sent.slot > 10 && sent.channel == channel) frames.push_back(sent);
  return frames;
}

// The numbers of the lists that arrived at receiver `node`.
inline std::vector<std::uint32_t> arrived(Rig& rig, std::size_t node, PduId pdu) {
  std::vector<std::uint32_t> sequences;
  for (const auto& one : rig.reports(node).arrived)
    if (one.pdu == pdu && one.effect == cni::ArrivalEffect::kCompleted) sequences.push_back(one.sequence);
  return sequences;
}

}  // namespace ttf::bus
