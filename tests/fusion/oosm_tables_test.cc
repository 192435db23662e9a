// Bar-Shalom, "Update with out-of-sequence measurements in tracking: exact solution", IEEE TAES 38(3), 2002,
// table I: scalar random walk, Q = R = 1, P(k-1|k-1) = 1, a late measurement half-way. Algorithms A, B and C
// are written out here, as the yardstick for what rewinding gives exactly.
#include <gtest/gtest.h>

namespace ttf {
namespace {

struct Result {
  double p_tau, w, p_calculated, mse;
};

Result algorithm(char which) {
  constexpr double q = 1, r = 1, p_before = 1, q_tau = 0.5;
  const double p_prior = p_before + q, s = p_prior + r, p = p_prior - p_prior * p_prior / s, b = 1 / s;
  const double pvv = which == 'A' ? q_tau - q_tau * b * q_tau : which == 'B' ? q_tau : 0.0;
  const double pxv = which == 'C' ? 0.0 : q_tau - p_prior * b * q_tau;
  Result result{};
  result.p_tau = p + pvv - 2 * pxv;
  const double cross = p - pxv, s_tau = result.p_tau + r;
  result.w = cross / s_tau;
  result.p_calculated = p - result.w * s_tau * result.w;
  // What B and C really achieve: their retrodiction x_tau = x has this error and this cross covariance.
  const double true_pxv = q_tau - p_prior * b * q_tau;
  const double error = which == 'A' ? result.p_tau : p + q_tau - 2 * true_pxv;
  const double pxz = p - true_pxv;
  result.mse = p - 2 * result.w * pxz + result.w * result.w * (error + r);
  return result;
}

TEST(BarShalom2002, TableOne) {
  const struct {
    char which;
    Result expected;
  } kTable[] = {{'A', {0.750, 0.286, 0.524, 0.524}},
                {'B', {0.833, 0.273, 0.530, 0.530}},
                {'C', {0.667, 0.400, 0.400, 0.560}}};
  for (const auto& row : kTable) {
    const Result result = algorithm(row.which);
    EXPECT_NEAR(result.p_tau, row.expected.p_tau, 5e-4) << row.which;
    EXPECT_NEAR(result.w, row.expected.w, 5e-4) << row.which;
    EXPECT_NEAR(result.p_calculated, row.expected.p_calculated, 5e-4) << row.which;
    EXPECT_NEAR(result.mse, row.expected.mse, 5e-4) << row.which;
  }
}

// In-order processing - what rewinding does - is the exact solution that algorithm A reproduces.
TEST(BarShalom2002, InOrderProcessingIsAlgorithmA) {
  const auto update = [](double p) { return p / (p + 1); };
  EXPECT_NEAR(update(update(1 + 0.5) + 0.5), 0.5238, 5e-5);
  EXPECT_NEAR(update(update(1 + 0.5) + 0.5), algorithm('A').p_calculated, 1e-15);
}

}  // namespace
}  // namespace ttf
