// Al1: Algorithm A over any number of lags, by an equivalent measurement (fusion/oosm/collapsed.h).
//
// Exact       at one lag, one late measurement after each in order, where it is Algorithm A. Further back "a few
//             percent" worse than optimal: the late measurement sees the later ones as if all were of t(k).
//             Estimates of earlier instants are not mended, so a second late measurement before the next in order
//             is approximate, too.
// Stores      x, P of every measurement in order within the capacity; no measurement.
// Costs       constant in the lag: two steps of the motion, an inverse of F, a factorisation of P*, some ten
//             products of n x n.
#pragma once

#include "fusion/oosm/collapsed.h"

namespace ttf::fusion::oosm {

template <int N, int M, Motion<N> Model, int Capacity>
using Al1 = Collapsed<N, M, Model, Capacity, Noise::kRetrodicted>;

}  // namespace ttf::fusion::oosm
