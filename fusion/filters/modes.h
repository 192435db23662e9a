// The estimate of the IMM (imm.h): each mode's estimate in its own layout, and the mode's probability.
#pragma once

#include <tuple>

#include "fusion/motion/motion_model.h"

namespace ttf::fusion::filters {

template <motion::Model... Ms> struct Modes {
  std::tuple<linear::Gaussian<Ms::kStates>...> estimates;
  linear::Vector<static_cast<int>(sizeof...(Ms))> probability =
      linear::Vector<static_cast<int>(sizeof...(Ms))>::Constant(1.0 / sizeof...(Ms));
};

}  // namespace ttf::fusion::filters
