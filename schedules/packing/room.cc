#include "schedules/packing/room.h"

#include <set>

#include "schedules/packing/first_fit.h"

namespace ttf::schedules::packing {

std::vector<Room> room_left(const Instance& instance, const Places& places, int bits) {
  const Packed packed = with_fixed(instance, places);
  std::vector<std::set<int>> bins_of(instance.nodes.size());
  for (std::size_t i = 0; i < places.size(); ++i)
    if (places[i]) bins_of[static_cast<std::size_t>(instance.signals[i].node)].insert(places[i]->bin);
  std::vector<Room> rooms;
  for (std::size_t node = 0; node < instance.nodes.size(); ++node) {
    Room room{static_cast<int>(node), 0, {}};
    const auto each_bin = [&](auto&& on) {
      for (std::size_t bin = 0; bin < packed.bins.size(); ++bin)
        if (instance.shared_slots || bins_of[node].contains(static_cast<int>(bin))) on(packed.bins[bin]);
    };
    // A frame's free bits are the places for signals of one bit in one cycle alone.
    each_bin([&](const Bin& bin) { room.free_bits += bin.room_for(room.node, instance.cycles, 1); });
    for (int repetition = 1; repetition <= instance.cycles; repetition *= 2) {
      room.signals.push_back(0);
      each_bin([&](const Bin& bin) { room.signals.back() += bin.room_for(room.node, repetition, bits); });
    }
    rooms.push_back(std::move(room));
  }
  return rooms;
}

}  // namespace ttf::schedules::packing
