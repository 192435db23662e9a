// Signals to be packed into frames of FlexRay's static segment, and the places they get.
//
// The static segment is a table with a column for each slot and a row for each of 1, 2, 4, ... or 64 cycles, which
// repeat. A field of the table is a frame of `payload_bits` bits. A signal of repetition R lies at the same bits of one
// slot in each cycle c with c mod R == first_cycle. In FlexRay 2.1 all frames of a slot belong to one node. In 3.0 they
// may belong to different nodes in different cycles (slot multiplexing).
//
// Variants of a vehicle share one schedule: a signal has the same place in each variant that has it. Signals that no
// variant has both of may overlap. In each variant a slot, or a frame of 3.0, has one owner.
//
// Source of the problem: Dvorak, Hanzalek, IEEE Transactions on Vehicular Technology, 2018,
// doi:10.1109/TVT.2018.2879920; Lukasiewycz, Glass, Teich, Milbredt, "FlexRay schedule optimization of the static
// segment", CODES+ISSS 2009.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/time.h"

namespace ttf::schedules::packing {

inline constexpr int kMostCycles = 64;
inline constexpr int kMostPayloadBits = 254 * 8;
inline constexpr int kLastStaticSlot = 1023;  // cStaticSlotIDMax

// The first cycles that a signal may have: earliest..latest, within 0..repetition - 1. There is none if latest <
// earliest.
struct Window {
  int earliest = 0;
  int latest = 0;

  bool empty() const { return latest < earliest; }
  bool operator==(const Window&) const = default;
};

// Returns the cycles that begin at or after the release and before the deadline, both from a period's beginning. So
// times are kept to the cycle: a deadline of 4 ms lets a cycle of 5 ms begin. `release` is not negative.
Window window_of(Duration cycle, Duration release, Duration deadline, int repetition);

// Variant v of the instance is bit v.
using VariantSet = std::uint64_t;
inline constexpr int kMostVariants = 64;
inline constexpr VariantSet kAllVariants = ~VariantSet{0};

struct Signal {
  std::string name;
  int node = 0;        // index of its sender
  int repetition = 1;  // 1, 2, 4, ..., at most the instance's cycles
  Window window;
  int bits = 1;                        // 1..payload_bits
  VariantSet variants = kAllVariants;  // one or more; bits beyond those of the instance do not count

  bool is_windowed() const { return window.earliest > 0 || window.latest < repetition - 1; }
};

struct Instance {
  std::vector<std::string> nodes;
  std::vector<Signal> signals;
  int payload_bits = 32;                   // 1..kMostPayloadBits
  int cycles = kMostCycles;                // 1, 2, 4, ..., 64
  bool shared_slots = false;               // FlexRay 3.0: a slot's cycles may belong to different nodes
  std::vector<std::string> variants = {};  // at most kMostVariants; none: all vehicles have all signals

  int variant_count() const { return variants.empty() ? 1 : static_cast<int>(variants.size()); }
  VariantSet all_variants() const { return kAllVariants >> (kMostVariants - variant_count()); }
};

// Calls on(variant) for each of the set, in their order.
template <class On> void each_variant(VariantSet set, On&& on) {
  for (; set != 0; set &= set - 1) on(std::countr_zero(set));
}

// Signals in order, by their index.
using Order = std::vector<std::size_t>;

// `bin` is a column of the table, before it has a slot's number (slot_numbers.h).
struct BitPlace {
  int bin = 0;
  int first_cycle = 0;
  int offset = 0;  // first bit within the frame

  bool operator==(const BitPlace&) const = default;
};

// By signal; a signal without an entry has no place.
using Places = std::vector<std::optional<BitPlace>>;

// Returns the signals that have a window and fit a frame.
Order possible_signals(const Instance& instance);
Order of_node(const Instance& instance, const Order& order, int node);

}  // namespace ttf::schedules::packing
