// Bits of a frame as they are written by hand.
#pragma once

#include <string>

namespace ttf::bus::can {

// Fields stand apart, and a stuff bit is in brackets: "0 0000[1]0010100". Returns the bits alone.
inline std::string joined(std::string spaced) {
  std::erase_if(spaced, [](char c) { return c != '0' && c != '1'; });
  return spaced;
}

}  // namespace ttf::bus::can
