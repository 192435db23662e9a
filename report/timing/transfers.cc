#include "report/timing/transfers.h"

#include <algorithm>
#include <bitset>
#include <map>
#include <tuple>

namespace ttf::report::timing {
namespace {

constexpr Duration kSameList = Duration::milliseconds(100);  // the largest gap between two frames of one list

}  // namespace

std::vector<Transfer> transfers_of(const TimingData& data) {
  std::vector<Transfer> transfers;
  std::map<std::tuple<LaneKey, PduId, std::uint32_t>, std::size_t> open;
  const auto add = [&](const Transfer& t) {
    const auto [entry, first] = open.try_emplace({t.lane, t.pdu, t.sequence}, transfers.size());
    if (!first && t.start - transfers[entry->second].end < kSameList) {
      transfers[entry->second].end = std::max(transfers[entry->second].end, t.end);
      return;
    }
    entry->second = transfers.size();
    transfers.push_back(t);
  };
  for (const auto& f : data.can_frames) add({{LaneKey::Kind::kCan, f.bus, 0}, f.start, f.end, f.pdu, f.sequence});
  // A state message is sent again in each of its slots. Only the first sending of each fragment is a transfer.
  struct Sent {
    std::bitset<256> fragments;
    TrueTime last;
  };
  std::map<std::tuple<std::uint8_t, PduId, std::uint32_t>, Sent> sent;
  for (const auto& f : data.slot_frames) {
    if (f.null_frame || f.pdu == kNoPdu) continue;
    const auto [entry, first] = sent.try_emplace({f.channel, f.pdu, f.sequence}, Sent{{}, f.end});
    if (f.start - entry->second.last >= kSameList) entry->second.fragments.reset();  // the counter has wrapped
    entry->second.last = f.end;
    if (entry->second.fragments[f.fragment]) continue;
    entry->second.fragments.set(f.fragment);
    add({{LaneKey::Kind::kChannel, f.channel, 0}, f.start, f.end, f.pdu, f.sequence});
  }
  return transfers;
}

}  // namespace ttf::report::timing
