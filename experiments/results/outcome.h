// Whether an expectation about an experiment holds, and the word for that in its answer.json.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string_view>

namespace ttf::experiments::results {

enum class Outcome : std::uint8_t { kHolds, kFails, kUndecided };

constexpr std::string_view to_text(Outcome outcome) {
  switch (outcome) {
    case Outcome::kHolds: return "holds";
    case Outcome::kFails: return "does not hold";
    case Outcome::kUndecided: break;
  }
  return "cannot tell";
}
constexpr std::optional<Outcome> outcome_of(std::string_view text) {
  for (const Outcome one : {Outcome::kHolds, Outcome::kFails, Outcome::kUndecided})
    if (to_text(one) == text) return one;
  return std::nullopt;
}

}  // namespace ttf::experiments::results
