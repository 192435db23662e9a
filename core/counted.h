// "1 worker", "2 workers": how many of what is counted, in words for people.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace ttf {

// Of nouns whose plural has an s more.
inline std::string counted(std::uint64_t count, std::string_view one) {
  return std::to_string(count) + " " + std::string(one) + (count == 1 ? "" : "s");
}

}  // namespace ttf
