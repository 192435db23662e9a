// Every motion model under every filter, for tests that hold of all.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <tuple>

#include "fusion/config/tracker_config.h"

namespace ttf::fusion {

using Choice = std::tuple<MotionModel, FilterKind>;

inline auto every_choice() {
  return testing::Combine(testing::Values(MotionModel::kConstantVelocity, MotionModel::kConstantAcceleration,
                                          MotionModel::kCtrv, MotionModel::kCtra, MotionModel::kInteracting),
                          testing::Values(FilterKind::kExtended, FilterKind::kUnscented));
}

inline std::string name_of_choice(const testing::TestParamInfo<Choice>& choice) {
  constexpr const char* kMotions[] = {"ConstantVelocity", "ConstantAcceleration", "Ctrv", "Ctra", "Interacting"};
  return std::string(kMotions[static_cast<std::size_t>(std::get<0>(choice.param))]) +
         (std::get<1>(choice.param) == FilterKind::kExtended ? "Extended" : "Unscented");
}

}  // namespace ttf::fusion
