// The hash that compares drives without comparing files.
//
// Each record hashes to 64 bits from (log time, kind, payload bytes). A log's hash is the sum of these modulo
// 2^64, mixed with their number. The payload has the record's time, kind, node and sequence numbers, and a sum
// ignores the order. The logs of separate processes thus agree with the log of one process
// (recording/merge/merge.h puts them into one). Equal records count as often as they occur. The hash is not
// cryptographic: it detects change, not malice.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

#include "recording/records/kinds.h"

namespace ttf::recording::log {

class ContentHash {
 public:
  // Ignores kinds that do not count in the hash (recording/records/records.h).
  void add(std::uint64_t log_time, std::uint8_t kind, std::string_view payload) {
    if (!records::counts_in_hash(static_cast<records::RecordKind>(kind))) return;
    std::uint64_t hash = mix(log_time ^ mix((static_cast<std::uint64_t>(payload.size()) << 8) | kind));
    std::size_t at = 0;
    for (; at + 8 <= payload.size(); at += 8) hash = mix(hash ^ word(payload.data() + at, 8));
    if (at < payload.size()) hash = mix(hash ^ word(payload.data() + at, payload.size() - at));
    sum_ += mix(hash);
    ++records_;
  }
  // Adds all records of another log.
  void add(const ContentHash& other) {
    sum_ += other.sum_;
    records_ += other.records_;
  }
  std::uint64_t records() const { return records_; }
  std::uint64_t value() const { return mix(sum_ ^ mix(records_)); }

  // 16 hex digits.
  static std::string text(std::uint64_t hash);

 private:
  // Finaliser of SplitMix64 (Steele, Lea, Flood: "Fast splittable pseudorandom number generators", OOPSLA
  // 2014); a bijection, so that a changed word changes the hash.
  static std::uint64_t mix(std::uint64_t z) {
    z += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  }
  // Little endian, like the platform (recording/mcap/bytes.h checks).
  static std::uint64_t word(const char* bytes, std::size_t count) {
    std::uint64_t value = 0;
    std::memcpy(&value, bytes, count);
    return value;
  }

  std::uint64_t sum_ = 0;
  std::uint64_t records_ = 0;
};

}  // namespace ttf::recording::log
