// Counts and lists of names as text for people.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace ttf {

// Returns "1 worker", "2 workers"; for nouns with a plural in s.
inline std::string counted(std::uint64_t count, std::string_view one) {
  return std::to_string(count) + " " + std::string(one) + (count == 1 ? "" : "s");
}

// Returns "a, b, c", or with another word before the last name: "a, b or c".
inline std::string joined(const std::vector<std::string>& names, std::string_view before_last = ", ") {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (i > 0) text += i + 1 == names.size() ? before_last : ", ";
    text += names[i];
  }
  return text;
}

}  // namespace ttf
