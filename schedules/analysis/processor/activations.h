// How often a task may be activated: at most floor((a + J) / T) + 1 times in a closed window of length a, for each T
// and J that is known. A flow that is bounded twice is bounded by the smaller (J. Y. Le Boudec, P. Thiran: Network
// Calculus, Springer 2001, section 1.2).
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

namespace ttf::schedules::analysis::processor {

struct ActivationBound {
  std::int64_t period = 0;  // T, 1 at least; nanoseconds
  std::int64_t jitter = 0;  // J
};

struct ActivationBounds {
  std::vector<ActivationBound> all;  // empty: nothing is known

  // In a closed window; where nothing is known, 1.
  std::int64_t most(std::int64_t window_ns) const;
  // Between two activations at the least.
  std::optional<std::int64_t> gap() const;
};

}  // namespace ttf::schedules::analysis::processor
