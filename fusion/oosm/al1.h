// Al1 extends Algorithm A to any number of lags by an equivalent measurement (fusion/oosm/collapsed.h).
//
// Exact       at one lag, for one late measurement after each in order; there it is Algorithm A. Further back it is "a
//             few percent" worse than optimal: the equivalent measurement treats all later ones as if made at t(k).
//             Estimates of earlier instants stay as they are, so a second late measurement before the next in order is
//             approximate, too.
// Stores      x, P of every measurement in order within the capacity; no measurement.
// Costs       constant in the lag: two steps of the motion, an inverse of F, a factorisation of P*, some ten products
//             of n x n.
#pragma once

#include "fusion/oosm/collapsed.h"

namespace ttf::fusion::oosm {

template <int N, int M, Motion<N> Model, int Capacity>
using Al1 = Collapsed<N, M, Model, Capacity, Noise::kRetrodicted>;

}  // namespace ttf::fusion::oosm
