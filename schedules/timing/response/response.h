// The answer of an analysis: a longest response, and how far it can be relied on.
//
// Times in this folder are whole numbers of one unit, which the caller chooses: mostly nanoseconds. An argument is at
// most kLongestArgument, 2.2 years in nanoseconds. A response beyond kLongestResponse counts as unbounded. In between
// nothing overflows: sums are 128 bits long.
#pragma once

#include <cstdint>

namespace ttf::schedules::timing::response {

inline constexpr std::int64_t kLongestArgument = std::int64_t{1} << 56;
inline constexpr std::int64_t kLongestResponse = std::int64_t{1} << 62;

enum class Quality : std::uint8_t {
  kExact,      // the model has a case that reaches it, or comes as near to it as one likes
  kBound,      // no case exceeds it; perhaps no case reaches it
  kUnbounded,  // the resource is overloaded, or so near to it (2^-60) that it cannot be distinguished
};

// The longest time from an arrival to the end of its work. The arrival is the nominal one, before its jitter.
struct Response {
  Quality quality = Quality::kUnbounded;
  std::int64_t longest = 0;  // 0 if unbounded

  bool bounded() const { return quality != Quality::kUnbounded; }
  bool keeps(std::int64_t deadline) const { return bounded() && longest <= deadline; }
  bool operator==(const Response&) const = default;
};

// Returns "exact", "bound" or "unbounded".
constexpr const char* word(Quality quality) {
  switch (quality) {
    case Quality::kExact: return "exact";
    case Quality::kBound: return "bound";
    case Quality::kUnbounded: break;
  }
  return "unbounded";
}

}  // namespace ttf::schedules::timing::response
