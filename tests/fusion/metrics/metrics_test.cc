// The chi-square distribution against closed forms and printed tables.
#include "fusion/metrics/chi_square.h"

#include <gtest/gtest.h>

#include <cmath>

namespace ttf::fusion::metrics {
namespace {

TEST(IncompleteGamma, MatchesItsClosedForms) {
  for (const double x : {0.0, 1e-6, 0.1, 0.9, 1.0, 1.9, 2.1, 5.0, 20.0, 60.0}) {
    EXPECT_NEAR(regularised_gamma(0.5, x), std::erf(std::sqrt(x)), 1e-13) << x;
    EXPECT_NEAR(regularised_gamma(1.0, x), -std::expm1(-x), 1e-13) << x;
    EXPECT_NEAR(regularised_gamma(3.0, x), 1.0 - std::exp(-x) * (1.0 + x + 0.5 * x * x), 1e-13) << x;
  }
  EXPECT_NEAR(regularised_gamma(5000.0, 5000.0), 0.5, 0.002);  // median close to the mean
}

TEST(ChiSquare, MatchesTheTables) {
  // Abramowitz and Stegun, table 26.8.
  const struct {
    double probability, degrees, value;
  } rows[] = {{0.95, 1, 3.84146},   {0.99, 1, 6.63490},   {0.95, 2, 5.99147},   {0.95, 3, 7.81473},
              {0.025, 4, 0.484419}, {0.975, 4, 11.1433},  {0.025, 10, 3.24697}, {0.975, 10, 20.4832},
              {0.005, 30, 13.7867}, {0.995, 30, 53.6720}, {0.95, 100, 124.342}, {0.025, 100, 74.2219}};
  for (const auto& row : rows)
    EXPECT_NEAR(chi_square_quantile(row.probability, row.degrees), row.value, 6e-6 * row.value)
        << row.probability << " " << row.degrees;
}

TEST(ChiSquare, InvertsTheDistribution) {
  for (const double degrees : {1.0, 2.0, 6.0, 400.0, 20000.0})
    for (const double probability : {1e-4, 0.025, 0.5, 0.9973, 0.999999})
      EXPECT_NEAR(regularised_gamma(0.5 * degrees, 0.5 * chi_square_quantile(probability, degrees)), probability, 1e-9);
}

}  // namespace
}  // namespace ttf::fusion::metrics
