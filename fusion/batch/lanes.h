// Four numbers in one register. Code for a double also works on four at once, operation by operation. Each lane
// gets the bits of the scalar code (no contraction, cmake/rooms.cmake).
#pragma once

#include <cstdint>

namespace ttf::fusion::batch {

inline constexpr int kLanes = 4;
using Lanes = double __attribute__((vector_size(kLanes * sizeof(double))));
using Mask = std::int64_t __attribute__((vector_size(kLanes * sizeof(std::int64_t))));  // -1: yes, 0: no

// Returns a if `where` is set, else b.
inline double select(bool where, double a, double b) { return where ? a : b; }
inline Lanes select(Mask where, Lanes a, Lanes b) { return where ? a : b; }

// The mask for numbers of kind V.
template <class V> struct MaskOf;
template <> struct MaskOf<double> { using Type = bool; };
template <> struct MaskOf<Lanes> { using Type = Mask; };

}  // namespace ttf::fusion::batch
