#include "schedules/file/load_pdus.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <string_view>
#include <utility>
#include <vector>

#include "schedules/model/limits.h"

namespace ttf::schedules::file {
namespace {

void load_signals(YamlMap& map, std::string_view key, std::vector<model::Signal>& signals, int& total_bits) {
  int offset = 0;
  for (YamlMap& entry : map.maps(key)) {
    model::Signal signal;
    signal.name = entry.text("name");
    signal.unit = entry.text_or("unit", "");
    signal.bits = static_cast<int>(entry.integer("bits", {1, model::kMostSignalBits}));
    signal.resolution = entry.number_or("resolution", 1.0, {model::kFinestResolution, model::kCoarsestResolution});
    signal.low = entry.number_or("low", 0.0, {-model::kLargestLow, model::kLargestLow});
    const double top = signal.low + (std::ldexp(1.0, signal.bits) - 1.0) * signal.resolution;
    signal.high = entry.number_or("high", top, {-model::kLargestLow, model::kLargestHigh});
    if (signal.high <= signal.low || signal.high > top + 0.5 * signal.resolution)
      entry.fail("high", fmt::format("must be above {} and at most {}: more does not fit {} bits", signal.low, top,
                                     signal.bits));
    signal.bit_offset = offset;
    offset += signal.bits;
    if (signal.name != "spare" && find_signal(signals, signal.name))
      entry.fail("name", "is the name of an earlier signal");
    entry.finish();
    signals.push_back(std::move(signal));
  }
  total_bits = offset;
}

}  // namespace

void load_pdu(YamlMap& map, const Names& names, model::PduLayout& layout) {
  layout.line = map.line();
  if (map.has("sensor")) layout.sensor = names.sensor(map, "sensor");
  layout.fragment_bytes = static_cast<int>(map.integer("fragment_bytes", {1, model::kMostFragmentBytes}, "bytes"));
  layout.max_elements = static_cast<int>(map.integer("max_elements", {1, 65535}));
  layout.elements_per_fragment =
      static_cast<int>(map.integer("elements_per_fragment", {1, 8 * model::kMostFragmentBytes}));
  load_signals(map, "header", layout.header, layout.header_bits);
  load_signals(map, "element", layout.element, layout.element_bits);
  layout.header_bits = (layout.header_bits + 7) / 8 * 8;
  if (layout.element.empty()) map.fail("element", "must have at least one signal");
  const auto needs = [&](std::string_view name, std::int64_t largest) {
    const auto found = find_signal(layout.header, name);
    if (!found)
      map.fail("header", fmt::format("must have a signal {}", name));
    else if (largest >= std::int64_t{1} << layout.header[*found].bits)
      map.fail("header", fmt::format("must give {} enough bits for {}", name, largest));
  };
  if (layout.max_fragments() > model::kMostFragments)
    map.fail("max_elements", fmt::format("must be at most {}: {} fragments of {} elements",
                                         model::kMostFragments * layout.elements_per_fragment, model::kMostFragments,
                                         layout.elements_per_fragment));
  // Sequence numbers are distinguishable only when they differ by less than half the range.
  needs("sequence", 4);
  needs("fragment", layout.max_fragments() - 1);
  needs("count", layout.max_elements);
  const int bits = layout.header_bits + layout.elements_per_fragment * layout.element_bits;
  if (bits > 8 * layout.fragment_bytes)
    map.fail("fragment_bytes", fmt::format("must be at least {}: header and {} elements take {} bits", (bits + 7) / 8,
                                           layout.elements_per_fragment, bits));
  map.finish();
}

}  // namespace ttf::schedules::file
