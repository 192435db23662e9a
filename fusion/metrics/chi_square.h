// Statistics that judge an estimator.
#pragma once

namespace ttf::fusion::metrics {

// Returns the regularised lower incomplete gamma function P(a, x), a > 0, x >= 0, by series below a + 1 and
// continued fraction above (Abramowitz and Stegun 6.5.29 and 6.5.31).
double regularised_gamma(double a, double x);

// Returns the quantile of the chi-square distribution with `degrees` > 0 degrees of freedom at `probability` in
// (0, 1).
double chi_square_quantile(double probability, double degrees);

}  // namespace ttf::fusion::metrics
