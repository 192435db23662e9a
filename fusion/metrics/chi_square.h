// Statistics that judge an estimator.
#pragma once

namespace ttf::fusion::metrics {

// Regularised lower incomplete gamma function P(a, x), a > 0, x >= 0 (series below a + 1, continued fraction
// above; Abramowitz and Stegun 6.5.29 and 6.5.31).
double regularised_gamma(double a, double x);

// Value that a chi-square variable of `degrees` > 0 degrees of freedom stays below with `probability`, which
// lies in (0, 1).
double chi_square_quantile(double probability, double degrees);

}  // namespace ttf::fusion::metrics
