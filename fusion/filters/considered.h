// What is kept of an object whose sensors' systematic errors are considered (consider.h): N states and their
// correlation with the B biases of all sensors together, each sensor's one after the other.
#pragma once

#include "fusion/linear/gaussian.h"

namespace ttf::fusion::filters {

template <int N, int B> struct Considered {
  linear::Gaussian<N> state;
  linear::Matrix<N, B> cross = linear::Matrix<N, B>::Zero();
};

}  // namespace ttf::fusion::filters
