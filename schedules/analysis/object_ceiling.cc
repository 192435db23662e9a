#include "schedules/analysis/object_ceiling.h"

#include <algorithm>
#include <cstddef>
#include <set>

#include "schedules/model/limits.h"

namespace ttf::schedules::analysis {
namespace {

int largest_of(const model::PduLayout& layout, const char* signal, int otherwise) {
  const auto index = find_signal(layout.header, signal);
  if (!index) return otherwise;
  const int bits = std::min(layout.header[*index].bits, 30);
  return (1 << bits) - 1;
}

ListRoom room_of(const model::Cluster& cluster, PduId pdu) {
  const model::PduLayout& layout = cluster.pdu(pdu);
  std::set<int> fragments;
  for (const model::FrameSlot& frame : cluster.frames)
    if (frame.pdu == pdu) fragments.insert(frame.fragment);
  ListRoom room{.pdu = pdu};
  room.slots = static_cast<int>(fragments.size());
  room.objects = std::min(layout.max_elements, room.slots * layout.elements_per_fragment);
  const int numbered = std::min(largest_of(layout, "fragment", model::kMostFragments - 1) + 1, model::kMostFragments);
  room.countable = std::min(largest_of(layout, "count", layout.max_elements), numbered * layout.elements_per_fragment);
  return room;
}

}  // namespace

ObjectCeiling object_ceiling(const model::Cluster& cluster) {
  ObjectCeiling ceiling;
  std::set<int> status;
  for (const model::FrameSlot& frame : cluster.frames) {
    if (frame.pdu == kNoPdu) {
      if (!is_dynamic(cluster.flexray, frame)) status.insert(frame.slot);
      continue;
    }
    const bool known = std::any_of(ceiling.lists.begin(), ceiling.lists.end(),
                                   [&](const ListRoom& room) { return room.pdu == frame.pdu; });
    if (!known) ceiling.lists.push_back(room_of(cluster, frame.pdu));
  }
  if (ceiling.lists.empty()) return ceiling;
  ceiling.free_for_lists = cluster.flexray.gNumberOfStaticSlots - static_cast<int>(status.size());
  const auto fewest = [&](int ListRoom::*member) {
    int least = ceiling.lists.front().*member;
    for (const ListRoom& room : ceiling.lists) least = std::min(least, room.*member);
    return least;
  };
  ceiling.carried = fewest(&ListRoom::objects);
  const auto slots_for = [&](int objects) {
    int slots = 0;
    for (const ListRoom& room : ceiling.lists) slots += cluster.pdu(room.pdu).fragments_of(objects);
    return slots;
  };
  ceiling.with_all_static_slots = ceiling.carried;
  const int countable = fewest(&ListRoom::countable);
  while (ceiling.with_all_static_slots < countable &&
         slots_for(ceiling.with_all_static_slots + 1) <= ceiling.free_for_lists)
    ++ceiling.with_all_static_slots;
  return ceiling;
}

}  // namespace ttf::schedules::analysis
