// Dual numbers against Eigen's automatic differentiation.
#include "fusion/tracks/body/dual_number.h"

#include <gtest/gtest.h>

#include <unsupported/Eigen/AutoDiff>

#include "core/random.h"

namespace ttf::fusion::tracks::body {
namespace {

using Oracle = Eigen::AutoDiffScalar<Eigen::Vector3d>;

// The same number twice.
struct Both {
  DualNumber ours;
  Oracle oracle;
};
Both drawn(RandomStream& stream) {
  const double value = 0.5 + stream.uniform();
  const Eigen::Vector3d by(stream.normal(), stream.normal(), stream.normal());
  Eigen::Array4d padded = Eigen::Array4d::Zero();
  padded.head<3>() = by.array();
  return {{value, padded}, {value, by}};
}
void expect_same(const DualNumber& ours, const Oracle& oracle) {
  EXPECT_EQ(ours.value, oracle.value());
  for (Eigen::Index k = 0; k < 3; ++k) EXPECT_EQ(ours.by(k), oracle.derivatives()(k)) << k;
  EXPECT_EQ(ours.by(3), 0.0);
}

TEST(DualNumber, EveryFunctionHasTheDerivativesOfTheOracle) {
  RandomStream stream({.seed = 1, .purpose = Purpose::kTest, .entity = 3, .index = 0});
  for (int i = 0; i < 1000; ++i) {
    const auto [a, p] = drawn(stream);
    const auto [b, q] = drawn(stream);
    expect_same(-a, Oracle(-p));
    expect_same(a + b, Oracle(p + q));
    expect_same(a - b, Oracle(p - q));
    expect_same(0.3 * a, Oracle(0.3 * p));
    expect_same(a * b, Oracle(p * q));
    expect_same(a / b, Oracle(p / q));
    expect_same(square(a), Oracle(p * p));
    expect_same(sqrt(a), Oracle(sqrt(p)));
    expect_same(log(a), Oracle(log(p)));
    expect_same(atan2(a, b), Oracle(atan2(p, q)));
    const auto [sine, cosine] = sine_and_cosine(a);
    expect_same(sine, Oracle(sin(p)));
    expect_same(cosine, Oracle(cos(p)));
  }
}

TEST(DualNumber, AVariableHasTheDerivativeOneByItself) {
  for (int k = 0; k < 3; ++k) expect_same(DualNumber::variable(2.5, k), Oracle(2.5, 3, k));
}

}  // namespace
}  // namespace ttf::fusion::tracks::body
