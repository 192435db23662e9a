#include "recording/exports/slot_status.h"

#include <cstddef>
#include <iterator>

namespace ttf::recording::exports {

std::string slot_status_words(std::uint8_t status) {
  static constexpr const char* kWords[] = {"syntax error",          "content error", "boundary violation",
                                           "transmission conflict", "no frame",      "unexpected frame"};
  std::string words;
  for (std::size_t bit = 0; bit < std::size(kWords); ++bit)
    if ((status >> bit) & 1u) words += (words.empty() ? "" : ", ") + std::string(kWords[bit]);
  return words.empty() ? "status " + std::to_string(status) : words;
}

}  // namespace ttf::recording::exports
