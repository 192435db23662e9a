#include "fusion/metrics/consistency.h"

#include "core/check.h"
#include "fusion/metrics/chi_square.h"

namespace ttf::fusion::metrics {

void Consistency::add(double squared, int degrees) {
  TTF_CHECK(degrees > 0, "{} degrees", degrees);
  sum_ += squared >= 0.0 ? squared : kNothing;
  ++samples_;
  degrees_ += static_cast<std::uint64_t>(degrees);
}

Band Consistency::band(double tail) const {
  TTF_CHECK(tail > 0.0 && tail < 0.5, "tail {}", tail);
  if (samples_ == 0) return {kNothing, kNothing};
  const auto samples = static_cast<double>(samples_), degrees = static_cast<double>(degrees_);
  return {chi_square_quantile(tail, degrees) / samples, chi_square_quantile(1.0 - tail, degrees) / samples};
}

}  // namespace ttf::fusion::metrics
