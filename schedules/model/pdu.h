// The layout of messages: lists of objects as fixed-point signals, cut into fragments of one frame each.
//
// A PDU is one list (of hit points, observations, image objects, ...). On a bus it consists of 1..fragments()
// fragments, each with the same header signals and up to `elements_per_fragment` elements:
//
//   | header signals | element 0 | element 1 | ... | padding 0 |      = fragment_bytes
//
// All fragments of a list carry the same sequence number. A list is used only when all fragments of one sequence
// number are present (never a torn one). Signals are packed in order, most significant bit first, without gaps.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/ids.h"

namespace ttf::schedules::model {

// physical = low + raw * resolution, raw an unsigned number of `bits` bits; high = the largest value in use.
struct Signal {
  std::string name;
  std::string unit;
  int bits = 0;  // 1..32
  double low = 0.0;
  double high = 0.0;
  double resolution = 1.0;
  int bit_offset = 0;  // from the start of the header or of the element (derived)
};

struct PduLayout {
  std::string name;
  SensorId sensor = kNoSensor;  // source of the list's measurement, if any
  int fragment_bytes = 0;
  int max_elements = 0;
  int elements_per_fragment = 0;
  std::vector<Signal> header;  // must contain "sequence", "fragment" and "count" (elements in the whole list)
  std::vector<Signal> element;
  int header_bits = 0;   // derived, rounded up to whole bytes
  int element_bits = 0;  // derived
  int line = 0;          // in the cluster file

  // Returns the fragments of a list of n elements (at least one: an empty list is a message too).
  int fragments_of(int n) const {
    return n <= elements_per_fragment ? 1 : (n + elements_per_fragment - 1) / elements_per_fragment;
  }
  int max_fragments() const { return fragments_of(max_elements); }
};

// Returns how many elements of so many bits fit into a fragment behind its header; at least 1, which may not fit.
constexpr int most_elements(int fragment_bytes, int header_bits, int element_bits) {
  const int room = 8 * fragment_bytes - header_bits;
  return element_bits > 0 && room > element_bits ? room / element_bits : 1;
}

// Returns the index of a signal in a header or element, or nullopt.
std::optional<std::size_t> find_signal(const std::vector<Signal>& signals, std::string_view name);

}  // namespace ttf::schedules::model
