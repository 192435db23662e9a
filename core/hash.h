// A name for a content.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace ttf {

// FNV-1a, 64 bits, in hexadecimal digits: names the exact input that something was made from.
inline std::string hex_hash(std::string_view text) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
  std::string digits;
  for (int shift = 60; shift >= 0; shift -= 4) digits += "0123456789abcdef"[(hash >> shift) & 0xf];
  return digits;
}

}  // namespace ttf
