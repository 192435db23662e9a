#include "schedules/packing/slot_numbers.h"

#include <algorithm>
#include <set>
#include <utility>

namespace ttf::schedules::packing {

std::vector<SlotNumber> slot_numbers(std::vector<SlotNumber> fixed, int bins, int first_slot, ChannelUse use) {
  std::set<std::pair<int, model::Channels>> taken;
  for (const SlotNumber& number : fixed) taken.emplace(number.slot, number.channels);
  std::vector<SlotNumber> numbers = std::move(fixed);
  while (static_cast<int>(numbers.size()) < bins) {
    SlotNumber next{first_slot, use == ChannelUse::kSame ? model::Channels::kAB : model::Channels::kA};
    if (use == ChannelUse::kIndependent &&
        slots_on(numbers, model::Channel::kA) > slots_on(numbers, model::Channel::kB))
      next.channels = model::Channels::kB;
    while (!taken.emplace(next.slot, next.channels).second) ++next.slot;
    numbers.push_back(next);
  }
  return numbers;
}

int slots_on(const std::vector<SlotNumber>& numbers, model::Channel channel) {
  return static_cast<int>(std::count_if(numbers.begin(), numbers.end(),
                                        [&](const SlotNumber& number) { return includes(number.channels, channel); }));
}

}  // namespace ttf::schedules::packing
