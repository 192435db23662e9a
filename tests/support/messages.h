// Messages for an exchange: the bytes of a node's n-th message, for its sender and its checker, in any
// process.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/ids.h"

namespace ttf::test {

enum class Sizes {
  kSmall,  // 1 to 256 bytes
  kAll,    // also empty ones, and now and then up to 64 KiB
};

// SplitMix64's output function (Steele, Lea, Flood 2014): scatters similar inputs.
constexpr std::uint64_t scattered(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15u;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

inline std::vector<std::byte> message(NodeId sender, std::uint64_t number, Sizes sizes) {
  const std::uint64_t draw = scattered(number * 256 + index_of(sender));
  std::size_t size = 1 + draw % 256;
  if (sizes == Sizes::kAll && draw / 256 % 8 == 0) size = draw / 4096 % 65537;
  if (sizes == Sizes::kAll && number == 7) size = 0;
  std::vector<std::byte> bytes(size);
  for (std::size_t i = 0; i < size; ++i)
    bytes[i] = static_cast<std::byte>(draw >> (i % 8 * 8)) ^ static_cast<std::byte>(i);
  return bytes;
}

// FNV-1a, going on from `hash`.
inline constexpr std::uint64_t kHashBegin = 0xcbf29ce484222325u;
inline std::uint64_t hash_of(std::span<const std::byte> bytes, std::uint64_t hash = kHashBegin) {
  for (const std::byte byte : bytes) hash = (hash ^ static_cast<std::uint64_t>(byte)) * 0x100000001b3u;
  return (hash ^ bytes.size()) * 0x100000001b3u;
}

}  // namespace ttf::test
