// The estimate of the consider filter (consider.h): N states and their correlation with the B biases of all
// sensors together, sensor after sensor.
#pragma once

#include "fusion/linear/gaussian.h"

namespace ttf::fusion::filters {

template <int N, int B> struct Considered {
  linear::Gaussian<N> state;
  linear::Matrix<N, B> cross = linear::Matrix<N, B>::Zero();
};

}  // namespace ttf::fusion::filters
