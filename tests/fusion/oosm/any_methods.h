// All methods, chosen at run time, for an axis and for a plane. They take long to compile, so any_methods.cc
// does it once, without inlining.
#pragma once

#include <gtest/gtest.h>

#include <optional>
#include <string>

#include "tests/fusion/oosm/any_method.h"
#include "tests/fusion/oosm/timelines.h"

namespace ttf::fusion::oosm {

template <int N, int M, Motion<N> Model, int Capacity> class Compiled {
 public:
  static constexpr int kStates = N, kDimension = M;
  static constexpr Exactness kExactness = Exactness::kApproximate;

  Compiled(Kind kind, const Model& motion);
  void start(GlobalTime time, const linear::Gaussian<N>& prior);
  bool announce(const Stamp& stamp);
  Taken take(const Stamp& stamp, const linear::LinearMeasurement<N, M>& measurement);
  std::optional<linear::Gaussian<N>> at(const Stamp& stamp) const;
  const linear::Gaussian<N>& state() const;
  GlobalTime time() const;
  Exactness exactness() const;
  Kind kind() const;

 private:
  AnyMethod<N, M, Model, Capacity, Capacity> method_;
};

using Line = ConstantVelocity<1>;
using Plane = ConstantVelocity<2>;
using OnLine = Compiled<2, 1, Line, 24>;
using OnPlane = Compiled<4, 2, Plane, 24>;
extern template class Compiled<2, 1, Line, 24>;
extern template class Compiled<4, 2, Plane, 24>;

static_assert(Method<OnLine> && Method<OnPlane>);

// Parameter of the tests that every method must pass.
inline auto every_kind() {
  std::vector<Kind> kinds;
  for (const NamedKind& named : kKinds) kinds.push_back(named.kind);
  return testing::ValuesIn(kinds);
}
inline std::string kind_of(const testing::TestParamInfo<Kind>& info) { return std::string(name_of(info.param)); }

}  // namespace ttf::fusion::oosm
