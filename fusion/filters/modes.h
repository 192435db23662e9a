// What is kept of an object that obeys one of several motion models at a time (imm.h): each mode's estimate in its own
// layout, and how probable the mode is.
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
