#include "schedules/packing/check.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "core/check.h"

namespace ttf::schedules::packing {
namespace {

// Returns the rule that a signal's own numbers break, or an empty text.
std::string own_violation(const Instance& instance, const Signal& signal, const Assigned& place) {
  if (place.number.slot < 0 || place.number.slot > kLastStaticSlot)
    return fmt::format("must have a slot of 0..{}, not {}", kLastStaticSlot, place.number.slot);
  if (signal.window.empty()) return "must have no place: it cannot meet its own window";
  if (place.first_cycle < signal.window.earliest || place.first_cycle > signal.window.latest)
    return fmt::format("must have its first cycle in {}..{}, not in {}", signal.window.earliest, signal.window.latest,
                       place.first_cycle);
  if (place.offset < 0 || place.offset + signal.bits > instance.payload_bits)
    return fmt::format("must have its {} bits within the {} of a frame: the first one is {}", signal.bits,
                       instance.payload_bits, place.offset);
  return {};
}

// The frames of one slot on one channel.
class Table {
 public:
  explicit Table(const Instance& instance)
      : instance_(instance),
        of_bit_(static_cast<std::size_t>(instance.cycles) * static_cast<std::size_t>(instance.payload_bits), kNone),
        in_cycle_(static_cast<std::size_t>(instance.cycles), kNone) {}

  // Returns the rule that the signal breaks beside those before it, or an empty text.
  std::string enter(std::size_t index, const Assigned& place) {
    const Signal& signal = instance_.signals[index];
    std::string wrong;
    for (int cycle = 0; cycle < instance_.cycles; ++cycle) {
      if (cycle % signal.repetition != place.first_cycle) continue;
      std::size_t& before = instance_.shared_slots ? in_cycle_[static_cast<std::size_t>(cycle)] : in_slot_;
      if (before == kNone) before = index;
      if (wrong.empty() && instance_.signals[before].node != signal.node)
        wrong = fmt::format("must not be in slot {}{}, which belongs to node {} of signal {}", place.number.slot,
                            instance_.shared_slots ? fmt::format(" of cycle {}", cycle) : "",
                            instance_.nodes[static_cast<std::size_t>(instance_.signals[before].node)],
                            instance_.signals[before].name);
      for (int bit = place.offset; bit < place.offset + signal.bits; ++bit) {
        std::size_t& at = of_bit_[static_cast<std::size_t>(cycle * instance_.payload_bits + bit)];
        if (at != kNone && wrong.empty())
          wrong = fmt::format("overlaps signal {} at bit {} of slot {} in cycle {}", instance_.signals[at].name, bit,
                              place.number.slot, cycle);
        if (at == kNone) at = index;
      }
    }
    return wrong;
  }

 private:
  static constexpr auto kNone = static_cast<std::size_t>(-1);

  const Instance& instance_;
  std::vector<std::size_t> of_bit_;    // the signal of each bit of each cycle
  std::vector<std::size_t> in_cycle_;  // the first signal of each cycle's frame
  std::size_t in_slot_ = kNone;        // the first signal of the slot
};

}  // namespace

Assignment assigned(const Places& places, const std::vector<SlotNumber>& numbers) {
  Assignment assignment(places.size());
  for (std::size_t i = 0; i < places.size(); ++i)
    if (places[i])
      assignment[i] = {numbers[static_cast<std::size_t>(places[i]->bin)], places[i]->first_cycle, places[i]->offset};
  return assignment;
}

std::vector<Violation> violations(const Instance& instance, const Assignment& assignment) {
  TTF_CHECK(assignment.size() == instance.signals.size(), "{} places of {} signals", assignment.size(),
            instance.signals.size());
  std::map<std::size_t, std::string> wrong;
  std::map<std::pair<int, model::Channel>, std::vector<std::size_t>> in_slot;
  for (std::size_t i = 0; i < assignment.size(); ++i) {
    if (!assignment[i]) continue;
    if (std::string own = own_violation(instance, instance.signals[i], *assignment[i]); !own.empty())
      wrong.emplace(i, std::move(own));
    else
      for (const model::Channel channel : model::kBothChannels)
        if (includes(assignment[i]->number.channels, channel))
          in_slot[{assignment[i]->number.slot, channel}].push_back(i);
  }
  for (const auto& [slot, signals] : in_slot) {
    Table table(instance);
    for (const std::size_t i : signals)
      if (std::string text = table.enter(i, *assignment[i]); !text.empty()) wrong.emplace(i, std::move(text));
  }
  std::vector<Violation> found;
  for (auto& [signal, text] : wrong) found.push_back({signal, std::move(text)});
  return found;
}

}  // namespace ttf::schedules::packing
