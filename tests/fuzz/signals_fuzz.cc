// Any text as signals to pack, and as places that stand. One that begins with a tag is a bus. Each mistake is a finding.
// Each accepted signal has a place, or is named as impossible. The packing passes the checker. It is not below its
// bound. Its file is read again as the same packing. Places that stand do not move. The bus of each variant has each
// signal in its cycles.
#include <algorithm>
#include <string>

#include "cli/schedule/packing/signal_file.h"
#include "core/check.h"
#include "schedules/packing/frames.h"
#include "schedules/packing/imported/bus_signals.h"
#include "schedules/packing/packer.h"
#include "schedules/packing/variants/check.h"
#include "schedules/packing/variants/packer.h"
#include "schedules/packing/variants/projection.h"
#include "tests/fuzz/harness.h"

namespace {

using namespace ttf;
using namespace ttf::schedules::packing;
using cli::schedule::packing::SignalFile;
using cli::schedule::packing::StandingPlaces;
using cli::schedule::packing::TableShape;

constexpr char kFile[] = "s.csv";

std::int64_t placed(const Places& places) {
  return std::count_if(places.begin(), places.end(), [](const auto& place) { return place.has_value(); });
}

void check_frames(const Instance& instance, const Assignment& assignment) {
  std::int64_t sent = 0, expected = 0;
  for (const PackedFrame& frame : frames_of(instance, assignment))
    sent += static_cast<std::int64_t>(frame.signals.size()) * (instance.cycles / frame.repetition);
  for (std::size_t i = 0; i < assignment.size(); ++i)
    if (assignment[i]) expected += instance.cycles / instance.signals[i].repetition;
  TTF_CHECK(sent == expected, "{} signals in frames, not {}", sent, expected);
}

void check_packing(const std::string& text, const TableShape& shape, ChannelUse use) {
  SignalFile file;
  if (!fuzz::accepted(kFile, [&] { file = cli::schedule::packing::parse_signals(text, kFile, shape); })) return;
  StandingPlaces standing;
  if (!fuzz::accepted(kFile, [&] { standing = parse_standing(text, kFile, file, use); })) standing = {};
  const Solution solution = file.instance.variants.empty()
                                ? pack(file.instance, standing.places, {3, 1})
                                : variants::pack_variants(file.instance, standing.places, {3, 1});
  const auto impossible = static_cast<std::int64_t>(file.impossible.size());
  TTF_CHECK(placed(solution.places) + impossible == static_cast<std::int64_t>(file.times.size()), "{} have a place",
            placed(solution.places));
  TTF_CHECK(solution.bins >= solution.bound(), "{} bins, at least {}", solution.bins, solution.bound());
  for (std::size_t i = 0; i < standing.places.size(); ++i)
    TTF_CHECK(!standing.places[i] || standing.places[i] == solution.places[i], "signal {} moved", i);
  const auto numbers = slot_numbers(standing.numbers, solution.bins, 1, use);
  const Assignment assignment = assigned(solution.places, numbers);
  for (const Violation& violation : variants::variant_violations(file.instance, assignment))
    TTF_CHECK(std::any_of(numbers.begin(), numbers.end(), [](const auto& one) { return one.slot > kLastStaticSlot; }),
              "signal {} {}", violation.signal, violation.text);
  for (int variant = 0; variant < file.instance.variant_count(); ++variant) {
    const variants::Projection vehicle = variants::projection(file.instance, variant);
    check_frames(vehicle.instance, vehicle.of(assignment));
  }
  const std::string once = packing_csv(file, assignment);
  const SignalFile again = cli::schedule::packing::parse_signals(once, kFile, shape);
  TTF_CHECK(packing_csv(again, assignment) == once, "a packing changes when written again: {}", once);
}

// A bus that stands: each of its signals has a place in the round.
void check_bus(const std::string& text) {
  imported::BusSignals bus;
  if (!fuzz::accepted(kFile, [&] { bus = imported::parse_bus_signals(text, kFile); })) return;
  for (const imported::BusSignal& signal : bus.signals)
    TTF_CHECK(bus.cycles % signal.repetition == 0 && signal.place.first_cycle < signal.repetition && signal.bits > 0,
              "{} in cycle {} of {}", signal.name, signal.place.first_cycle, signal.repetition);
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string text = fuzz::text_of(data + 1, size - 1);
  const int how = data[0];
  const TableShape shape{Duration::milliseconds(5), how % 2 == 0 ? 64 : 20, how % 3 == 0 ? 64 : 8, how % 5 == 0};
  if (text.starts_with('<'))
    check_bus(text);
  else
    check_packing(text, shape, static_cast<ChannelUse>(how % 7 % 3));
  return 0;
}
