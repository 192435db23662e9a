// Names for contents.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace ttf {

// Returns the FNV-1a hash (64 bits) in hexadecimal digits. It identifies the exact input of a result.
inline std::string hex_hash(std::string_view text) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
  std::string digits;
  for (int shift = 60; shift >= 0; shift -= 4) digits += "0123456789abcdef"[(hash >> shift) & 0xf];
  return digits;
}

}  // namespace ttf
