// Enumerations whose enumerators are bits: a value is a set of them. Beside such an enumeration, kIsBits is specialised.
#pragma once

#include <type_traits>

namespace ttf::recording::records {

template <class Bits> inline constexpr bool kIsBits = false;

template <class Bits>
requires kIsBits<Bits>
constexpr Bits operator|(Bits a, Bits b) {
  using Number = std::underlying_type_t<Bits>;
  return static_cast<Bits>(static_cast<Number>(a) | static_cast<Number>(b));
}
template <class Bits>
requires kIsBits<Bits>
constexpr Bits& operator|=(Bits& a, Bits b) { return a = a | b; }

// Returns whether the set has one of the bits.
template <class Bits>
requires kIsBits<Bits>
constexpr bool has(Bits set, Bits bits) {
  using Number = std::underlying_type_t<Bits>;
  return (static_cast<Number>(set) & static_cast<Number>(bits)) != 0;
}

}  // namespace ttf::recording::records
