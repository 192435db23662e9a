// Bl1 extends Algorithm B to any number of lags by an equivalent measurement (fusion/oosm/collapsed.h).
//
// Exact       without process noise, for one late measurement after each in order.
// Stores      x, P of every measurement in order within the capacity; no measurement.
// Costs       as Al1, slightly less. Do not mix its mean with Al1's covariance: that is inconsistent at several lags.
#pragma once

#include "fusion/oosm/collapsed.h"

namespace ttf::fusion::oosm {

template <int N, int M, Motion<N> Model, int Capacity> using Bl1 = Collapsed<N, M, Model, Capacity, Noise::kIgnored>;

}  // namespace ttf::fusion::oosm
