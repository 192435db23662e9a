#include "schedules/exchange/fibex/lists.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <set>

#include "schedules/model/limits.h"

namespace ttf::schedules::exchange::fibex {
namespace {

bool same_meaning(const model::Signal& a, const model::Signal& b) {
  return a.unit == b.unit && a.bits == b.bits && a.low == b.low && a.high == b.high && a.resolution == b.resolution;
}

// Returns the reason why a cluster file cannot express the signal, or an empty text.
std::string unlike_ours(const FibexSignal& signal) {
  const model::Signal& s = signal.meaning;
  if (!signal.unlike.empty()) return fmt::format("{}: {}", signal.name, signal.unlike);
  const double top = s.low + (std::ldexp(1.0, s.bits) - 1.0) * s.resolution;
  const bool in_range = s.bits <= model::kMostSignalBits && s.resolution >= model::kFinestResolution &&
                        s.resolution <= model::kCoarsestResolution && std::abs(s.low) <= model::kLargestLow &&
                        s.high <= model::kLargestHigh && s.high > s.low && s.high <= top + 0.5 * s.resolution;
  return in_range ? "" : fmt::format("{}: its range is not one of a cluster file", signal.name);
}

// Takes signals that follow each other without gaps from the first bit on; otherwise returns the reason.
std::string take_contiguous(const FibexPdu& pdu, std::vector<model::Signal>& signals, int& bits) {
  bits = 0;
  for (const FibexSignal& signal : pdu.signals) {
    if (std::string reason = unlike_ours(signal); !reason.empty()) return reason;
    if (signal.offset() != bits)
      return fmt::format("{}: it does not follow the signal before it, most significant bit first", signal.name);
    signals.push_back(signal.meaning);
    signals.back().bit_offset = bits;
    bits += signal.meaning.bits;
  }
  return signals.empty() ? fmt::format("{} has no signals", pdu.name) : "";
}

// Returns 12 for "x_12" and cuts the name to "x".
std::optional<int> take_index(std::string& name) {
  const auto at = name.rfind('_');
  if (at == std::string::npos || at == 0) return std::nullopt;
  int index = 0;
  const char* end = name.data() + name.size();
  const auto [last, error] = std::from_chars(name.data() + at + 1, end, index);
  if (error != std::errc{} || last != end || name[at + 1] == '-') return std::nullopt;
  name.resize(at);
  return index;
}

// Takes the signals of one element if `all` are several equal elements; otherwise all of them are one element.
int take_elements(const std::vector<model::Signal>& all, std::vector<model::Signal>& element) {
  element.clear();
  std::vector<model::Signal> stems = all;
  std::size_t size = 0;
  bool alike = true;
  for (std::size_t i = 0; i < stems.size() && alike; ++i) {
    const auto index = take_index(stems[i].name);
    if (index == 0 && size == i) ++size;
    alike = index && size > 0 && *index == static_cast<int>(i / size) && stems[i].name == stems[i % size].name &&
            same_meaning(stems[i], stems[i % size]);
  }
  if (!alike || stems.size() % size != 0) {
    element = all;
    return 1;
  }
  element.assign(stems.begin(), stems.begin() + static_cast<std::ptrdiff_t>(size));
  return static_cast<int>(stems.size() / size);
}

bool names_differ(const std::vector<model::Signal>& signals) {
  std::set<std::string> names;
  for (const model::Signal& signal : signals)
    if (signal.name != "spare" && !names.insert(signal.name).second) return false;
  return true;
}

// Checks the loader's rules for the header, and that the switch is its fragment number.
std::string check_header(const model::PduLayout& layout, const FibexMultiplexer& multiplexer) {
  const auto needs = [&](const char* name, std::int64_t largest) {
    const auto found = find_signal(layout.header, name);
    return found && largest < std::int64_t{1} << layout.header[*found].bits;
  };
  if (!needs("sequence", 4) || !needs("count", layout.max_elements) || !needs("fragment", layout.max_fragments() - 1))
    return "its static part has no signals sequence, fragment and count, wide enough";
  const model::Signal& fragment = layout.header[*find_signal(layout.header, "fragment")];
  FibexSignal selector;
  selector.position = multiplexer.switch_position;
  selector.high_low = multiplexer.switch_high_low;
  selector.meaning.bits = multiplexer.switch_bits;
  if (selector.offset() != fragment.bit_offset || multiplexer.switch_bits != fragment.bits)
    return "its switch is not the signal fragment of its static part";
  return "";
}

// Finds the PDU of every fragment; otherwise returns the reason.
std::string find_elements(const FibexMultiplexer& multiplexer, const std::map<std::string, const FibexPdu*>& by_id,
                          const FibexPdu*& elements) {
  std::set<std::int64_t> codes;
  for (const auto& [code, id] : multiplexer.layouts) {
    codes.insert(code);
    if (id != multiplexer.layouts.front().second) return "its fragments do not all have the same signals";
  }
  if (codes.empty() || *codes.rbegin() + 1 != static_cast<std::int64_t>(multiplexer.layouts.size()) ||
      codes.size() != multiplexer.layouts.size() || codes.size() > model::kMostFragments)
    return fmt::format("its switch codes are not 0, 1, ..., at most {}", model::kMostFragments - 1);
  const auto found = by_id.find(multiplexer.layouts.front().second);
  if (found == by_id.end()) return "its dynamic part is not a PDU of this file";
  elements = found->second;
  return "";
}

std::string take_list(const FibexPdu& pdu, const std::map<std::string, const FibexPdu*>& by_id,
                      model::PduLayout& layout) {
  if (!pdu.multiplexer) return "it has no multiplexer, thus no fragments";
  const FibexMultiplexer& multiplexer = *pdu.multiplexer;
  if (!multiplexer.unlike.empty()) return multiplexer.unlike;
  if (!pdu.signals.empty()) return "it has signals beside its multiplexer";
  const auto header = by_id.find(multiplexer.static_pdu);
  if (header == by_id.end()) return "its static part is not a PDU of this file";
  const FibexPdu* elements = nullptr;
  if (std::string reason = find_elements(multiplexer, by_id, elements); !reason.empty()) return reason;
  if (header->second->multiplexer || elements->multiplexer) return "its parts have multiplexers themselves";

  layout.name = pdu.name;
  layout.line = pdu.line;
  layout.fragment_bytes = pdu.bytes;
  if (std::string reason = take_contiguous(*header->second, layout.header, layout.header_bits); !reason.empty())
    return reason;
  layout.header_bits = (layout.header_bits + 7) / 8 * 8;
  if (multiplexer.dynamic_position != layout.header_bits)
    return "its dynamic part does not follow the header's last byte";
  std::vector<model::Signal> all;
  int bits = 0;
  if (std::string reason = take_contiguous(*elements, all, bits); !reason.empty()) return reason;
  layout.elements_per_fragment = take_elements(all, layout.element);
  layout.element_bits = bits / layout.elements_per_fragment;
  if (layout.fragment_bytes > model::kMostFragmentBytes || layout.header_bits + bits > 8 * layout.fragment_bytes)
    return "its signals do not fit its length";
  if (!names_differ(layout.header) || !names_differ(layout.element)) return "two of its signals have the same name";
  const int fragments = static_cast<int>(multiplexer.layouts.size());
  layout.max_elements = pdu.max_elements.value_or(fragments * layout.elements_per_fragment);
  if (layout.max_elements > 65535 || layout.max_fragments() != fragments)
    return fmt::format("its {} fragments do not hold {} elements", fragments, layout.max_elements);
  return check_header(layout, multiplexer);
}

}  // namespace

ListFound as_list(const FibexPdu& pdu, const std::map<std::string, const FibexPdu*>& by_id) {
  model::PduLayout layout;
  std::string reason = take_list(pdu, by_id, layout);
  if (!reason.empty()) return {std::nullopt, std::move(reason)};
  return {std::move(layout), {}};
}

}  // namespace ttf::schedules::exchange::fibex
