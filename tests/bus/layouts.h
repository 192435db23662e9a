// PDU layouts for tests, with the loader's derived fields, and lists of them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "bus/cni/list_buffer.h"
#include "bus/wire/pdu_codec.h"
#include "schedules/model/pdu.h"

namespace ttf::bus {

inline schedules::model::Signal signal(std::string name, int bits, double low = 0.0, double resolution = 1.0) {
  schedules::model::Signal s;
  s.name = std::move(name);
  s.bits = bits;
  s.low = low;
  s.resolution = resolution;
  s.high = low + (static_cast<double>(std::uint64_t{1} << bits) - 1.0) * resolution;
  return s;
}

inline void derive(std::vector<schedules::model::Signal>& signals, int& total) {
  total = 0;
  for (schedules::model::Signal& s : signals) {
    s.bit_offset = total;
    total += s.bits;
  }
}

// Elements of one 16-bit signal, `per_fragment` in each.
inline schedules::model::PduLayout list_layout(int sequence_bits = 4, int max_elements = 10, int per_fragment = 3) {
  schedules::model::PduLayout layout;
  layout.name = "list";
  layout.max_elements = max_elements;
  layout.elements_per_fragment = per_fragment;
  layout.header = {signal("fragment", 4), signal("sequence", sequence_bits), signal("count", 5)};
  layout.element = {signal("value", 16)};
  derive(layout.header, layout.header_bits);
  derive(layout.element, layout.element_bits);
  layout.header_bits = (layout.header_bits + 7) / 8 * 8;
  layout.fragment_bytes = (layout.header_bits + per_fragment * layout.element_bits) / 8;
  return layout;
}

// Fragments of a list whose i-th element is `seed` + i.
struct MadeList {
  const schedules::model::PduLayout* layout;
  std::uint32_t sequence;
  int fragments;
  std::vector<std::byte> bytes;

  MadeList(const schedules::model::PduLayout& of, std::uint32_t number, int count, std::uint32_t seed)
      : layout(&of), sequence(number), fragments(of.fragments_of(count)),
        bytes(static_cast<std::size_t>(fragments) * static_cast<std::size_t>(of.fragment_bytes)) {
    const std::uint32_t mask = (1u << of.header[1].bits) - 1;
    for (int f = 0; f < fragments; ++f) {
      const auto payload = fragment(f);
      wire::write_header_raw(of, payload, 0, static_cast<std::uint32_t>(f));
      wire::write_header_raw(of, payload, 1, number & mask);
      wire::write_header_raw(of, payload, 2, static_cast<std::uint32_t>(count));
      for (int e = 0; e < of.elements_per_fragment && f * of.elements_per_fragment + e < count; ++e)
        wire::write_element_raw(of, payload, e, 0, seed + static_cast<std::uint32_t>(f * of.elements_per_fragment + e));
    }
  }

  std::span<std::byte> fragment(int f) {
    const auto size = static_cast<std::size_t>(layout->fragment_bytes);
    return std::span(bytes).subspan(static_cast<std::size_t>(f) * size, size);
  }
  cni::ListView view() const { return {sequence, fragments, bytes}; }
};

}  // namespace ttf::bus
