// Protobuf's wire format (https://protobuf.dev/programming-guides/encoding), out and in. Private to recording/log.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <string_view>
#include <type_traits>

#include "recording/mcap/bytes.h"

namespace ttf::recording::log {

enum class WireType : std::uint8_t { kVarint = 0, kFixed64 = 1, kBlock = 2, kGroup = 3, kGroupEnd = 4, kFixed32 = 5 };

// Times, and records' signed numbers, are zigzag numbers on the wire; choices and ids are unsigned.
template <class T>
concept IsTime = requires(const T& value) {
  value.ns;
};
template <class T>
concept IsVarint = std::is_integral_v<T> || std::is_enum_v<T> || IsTime<T>;

template <IsVarint T> constexpr std::uint64_t varint_of(const T& value) {
  if constexpr (IsTime<T>)
    return varint_of(value.ns);
  else if constexpr (std::is_enum_v<T> || !std::is_signed_v<T>)
    return static_cast<std::uint64_t>(value);
  else
    return (static_cast<std::uint64_t>(value) << 1) ^ (value < 0 ? ~std::uint64_t{0} : 0);
}
// Returns whether the number fits the type. A number of up to 32 bits is cut to its last 32 bits before.
template <IsVarint T> constexpr bool from_varint(std::uint64_t bits, T& value) {
  if constexpr (IsTime<T>) {
    return from_varint(bits, value.ns);
  } else if constexpr (std::is_same_v<T, bool>) {
    value = bits != 0;
    return true;
  } else if constexpr (std::is_enum_v<T>) {
    std::underlying_type_t<T> number{};
    const bool fits = from_varint(bits, number);
    value = static_cast<T>(number);
    return fits;
  } else {
    if constexpr (sizeof(T) < 8) bits &= 0xffff'ffffu;
    const std::uint64_t number = std::is_signed_v<T> ? (bits >> 1) ^ (~(bits & 1) + 1) : bits;
    value = static_cast<T>(number);
    return static_cast<std::uint64_t>(value) == number;
  }
}

// Writes one message after another into the same memory, which grows to the largest.
class WireWriter {
 public:
  WireWriter() : bytes_(kFirstSize, '\0'), at_(bytes_.data()), end_(at_ + bytes_.size()) {}
  WireWriter(const WireWriter&) = delete;
  WireWriter& operator=(const WireWriter&) = delete;

  void clear() { at_ = bytes_.data(); }
  std::string_view bytes() const { return {bytes_.data(), size()}; }

  void varint(std::uint64_t value) {
    reserve(kLongestVarint);
    at_ = put(at_, value);
  }
  void number(std::uint32_t number, std::uint64_t value) {
    reserve(2 * kLongestVarint);
    at_ = put(put(at_, tag_of(number, WireType::kVarint)), value);
  }
  void number(std::uint32_t number, double value) {
    reserve(kLongestVarint + sizeof value);
    at_ = put(at_, tag_of(number, WireType::kFixed64));
    raw(&value, sizeof value);
  }
  void raw(const void* bytes, std::size_t size) {
    if (size == 0) return;
    reserve(size);
    std::memcpy(at_, bytes, size);
    at_ += size;
  }
  void block(std::uint32_t number, const void* bytes, std::size_t size) {
    varint(tag_of(number, WireType::kBlock));
    varint(size);
    raw(bytes, size);
  }
  // A block that `write` writes, of a size that only then is given. Few are longer than one byte can say.
  template <class Write> void block(std::uint32_t number, Write&& write) {
    varint(tag_of(number, WireType::kBlock));
    varint(0);
    const std::size_t begin = size();
    write();
    const std::size_t length = size() - begin;
    const auto more = length < 0x80 ? 0 : static_cast<std::size_t>((std::bit_width(length) - 1) / 7);
    if (more > 0) {
      reserve(more);
      std::memmove(bytes_.data() + begin + more, bytes_.data() + begin, length);
      at_ += more;
    }
    put(bytes_.data() + begin - 1, length);
  }

 private:
  static constexpr std::size_t kFirstSize = 64 * 1024, kLongestVarint = 10;

  static constexpr std::uint64_t tag_of(std::uint32_t number, WireType type) {
    return number << 3 | static_cast<std::uint32_t>(type);
  }
  static char* put(char* at, std::uint64_t value) {
    for (; value >= 0x80; value >>= 7) *at++ = static_cast<char>(value | 0x80);
    *at++ = static_cast<char>(value);
    return at;
  }
  std::size_t size() const { return static_cast<std::size_t>(at_ - bytes_.data()); }
  void reserve(std::size_t more) {
    if (static_cast<std::size_t>(end_ - at_) >= more) return;
    const std::size_t before = size();
    bytes_.resize(std::max(2 * bytes_.size(), before + more));
    at_ = bytes_.data() + before;
    end_ = bytes_.data() + bytes_.size();
  }

  std::string bytes_;
  char* at_;
  char* end_;
};

// Takes fields off the front of untrusted bytes, as its base does.
class WireReader : public mcap::FieldReader {
 public:
  using FieldReader::FieldReader;

  bool more() const { return ok() && !rest().empty(); }
  std::uint64_t varint() {
    std::uint64_t value = 0;
    for (unsigned shift = 0; shift < 70; shift += 7) {
      const auto byte = take<std::uint8_t>();
      value |= std::uint64_t{byte & 0x7fu} << shift;
      if (byte < 0x80) return value;
    }
    fail();
    return 0;
  }
  // At most five bytes. Bits beyond the 32nd are dropped, as protobuf does.
  std::uint32_t tag() {
    const std::size_t before = rest().size();
    const std::uint64_t tag = varint();
    if (before - rest().size() > 5) fail();
    return static_cast<std::uint32_t>(tag);
  }
  std::string_view block() { return bytes(varint()); }

  // Passes over a field of `tag`, with the groups in it.
  void skip(std::uint32_t tag, int depth = 0) {
    if (tag >> 3 == 0) return fail();
    switch (static_cast<WireType>(tag & 7)) {
      case WireType::kVarint: varint(); return;
      case WireType::kFixed64: bytes(8); return;
      case WireType::kBlock: block(); return;
      case WireType::kFixed32: bytes(4); return;
      case WireType::kGroup:
        while (ok() && depth < kDeepest) {
          const std::uint32_t inner = this->tag();
          if (inner == tag + 1) return;  // the end of the same group
          skip(inner, depth + 1);
        }
        break;
      case WireType::kGroupEnd: break;
    }
    fail();
  }

 private:
  static constexpr int kDeepest = 100;

  void fail() { bytes(std::numeric_limits<std::uint64_t>::max()); }
};

}  // namespace ttf::recording::log
