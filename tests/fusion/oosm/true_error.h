// The true covariance of a method's error, without random numbers. Gains depend on no measurement, so the
// error is linear in all noises. The method runs once for each independent part, at one sigma. The outer
// products of the errors add up.
#pragma once

#include <Eigen/Cholesky>

#include "tests/fusion/oosm/timelines.h"

namespace ttf::fusion::oosm {

// `method` is constructed, but not started.
template <Method X, class Model>
linear::Matrix<X::kStates> true_error(const X& method, const Model& motion, const linear::Matrix<X::kStates>& prior,
                                      const Timeline<X::kStates, X::kDimension>& arrivals) {
  constexpr int kN = X::kStates, kM = X::kDimension;
  const int count = static_cast<int>(arrivals.size());
  std::vector<int> order;
  for (int i = 0; i < count; ++i) order.push_back(i);
  const auto event = [&](int i) -> const auto& { return arrivals[static_cast<std::size_t>(i)]; };
  std::sort(order.begin(), order.end(), [&](int a, int b) { return event(a).stamp < event(b).stamp; });

  // One part: component c of the prior (at = -1), of the noise before the at-th instant, or of its
  // measurement.
  const auto error = [&](int at, bool measured, int component) {
    linear::Vector<kN> truth = linear::Vector<kN>::Zero();
    if (at < 0) truth = linear::Matrix<kN>(prior.llt().matrixL()).col(component);
    Timeline<kN, kM> seen = arrivals;
    GlobalTime time{};
    for (int k = 0; k < count; ++k) {
      auto& here = seen[static_cast<std::size_t>(order[static_cast<std::size_t>(k)])];
      if (here.stamp.time() > time) {
        const linear::LinearStep<kN> step = motion.step((here.stamp.time() - time).seconds());
        truth = (step.f * truth).eval();
        if (k == at && !measured) truth += linear::Matrix<kN>(step.q.llt().matrixL()).col(component);
        time = here.stamp.time();
      }
      here.measurement.z = here.measurement.h * truth;
      if (k == at && measured)
        here.measurement.z += linear::Matrix<kM>(here.measurement.r.llt().matrixL()).col(component);
    }
    X run = method;
    run.start(GlobalTime{}, {linear::Vector<kN>::Zero(), prior});
    take_all(run, seen);
    return linear::Vector<kN>(truth - run.state().x);
  };

  linear::Matrix<kN> sum = linear::Matrix<kN>::Zero();
  const auto add = [&](int at, bool measured, int components) {
    for (int c = 0; c < components; ++c) {
      const linear::Vector<kN> e = error(at, measured, c);
      sum += e * e.transpose();
    }
  };
  add(-1, false, kN);
  for (int k = 0; k < count; ++k) {
    add(k, false, kN);
    add(k, true, kM);
  }
  return sum;
}

}  // namespace ttf::fusion::oosm
