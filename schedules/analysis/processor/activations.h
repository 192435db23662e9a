// Bounds the activations of a task. For each known pair of T and J there are at most floor((a + J) / T) + 1 in a
// closed window of length a. The smallest of several bounds applies (J. Y. Le Boudec, P. Thiran: Network
// Calculus, Springer 2001, section 1.2).
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

namespace ttf::schedules::analysis::processor {

struct ActivationBound {
  std::int64_t period = 0;  // T, at least 1; nanoseconds
  std::int64_t jitter = 0;  // J
};

struct ActivationBounds {
  std::vector<ActivationBound> all;  // empty: no bound is known

  // Returns the most activations in a closed window; 1 if no bound is known.
  std::int64_t most(std::int64_t window_ns) const;
  // Returns the shortest time between two activations.
  std::optional<std::int64_t> gap() const;
};

}  // namespace ttf::schedules::analysis::processor
