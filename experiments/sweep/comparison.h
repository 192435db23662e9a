// Comparisons of an experiment: of paradigms, of the values of one axis, and of an axis's effects on two paradigms.
#pragma once

#include <cstddef>
#include <cstdint>

namespace ttf::experiments::sweep {

// Each paradigm at a value of the axis is compared with itself at the axis's baseline, all else equal.
struct AxisComparison {
  std::size_t axis = 0;      // in SweepFile::grid()
  std::size_t baseline = 0;  // in its settings
};

// kRatio: a change is a share of the value before, so that two changes are compared by the ratio of their factors.
// kDifference: a change is a difference in the measure's unit.
enum class Scale : std::uint8_t { kRatio, kDifference };

// Whether the change of an axis from one value to another lowers a measure of paradigm `first` more than of `second`.
struct Interaction {
  std::size_t measure = 0;            // in SweepFile::measures
  std::size_t axis = 0;               // in SweepFile::grid()
  std::size_t before = 0, after = 0;  // in the axis's settings
  std::size_t first = 0, second = 0;  // in SweepFile::paradigms
  Scale scale = Scale::kRatio;
};

// A paradigm at a point, with which another one is compared.
struct Reference {
  std::uint32_t point = 0;
  std::size_t paradigm = 0;
};

}  // namespace ttf::experiments::sweep
