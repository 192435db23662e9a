// Every motion model under every filter, for tests common to all.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <tuple>

#include "fusion/config/tracker_config.h"

namespace ttf::fusion {

using Choice = std::tuple<config::MotionModel, config::FilterKind>;

inline auto every_choice() {
  return testing::Combine(
      testing::Values(config::MotionModel::kConstantVelocity, config::MotionModel::kConstantAcceleration,
                      config::MotionModel::kCtrv, config::MotionModel::kCtra, config::MotionModel::kInteracting),
      testing::Values(config::FilterKind::kExtended, config::FilterKind::kUnscented));
}

inline std::string name_of_choice(const testing::TestParamInfo<Choice>& choice) {
  constexpr const char* kMotions[] = {"ConstantVelocity", "ConstantAcceleration", "Ctrv", "Ctra", "Interacting"};
  return std::string(kMotions[static_cast<std::size_t>(std::get<0>(choice.param))]) +
         (std::get<1>(choice.param) == config::FilterKind::kExtended ? "Extended" : "Unscented");
}

}  // namespace ttf::fusion
