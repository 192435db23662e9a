// The common part of the readers of pcap and pcapng. Private to the module.
#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

#include "core/errors.h"
#include "recording/capture/blocks.h"
#include "recording/capture/reader.h"

namespace ttf::recording::capture {

inline constexpr std::int64_t kSecond_ns = 1'000'000'000;

// Returns a number in the byte order of the file.
template <class Int> Int number_at(std::string_view bytes, std::size_t at, bool swapped) {
  static_assert(sizeof(Int) <= 8);
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < sizeof(Int); ++i) {
    const std::size_t from = swapped ? i : sizeof(Int) - 1 - i;
    value = (value << 8) | static_cast<unsigned char>(bytes[at + from]);
  }
  return static_cast<Int>(value);
}

// The state of reading one capture: its place in the bytes, and its errors.
class CaptureParser {
 public:
  CaptureParser(Capture& capture, const std::string& name) : capture_(capture), name_(name), bytes_(capture.bytes) {}

 protected:
  std::size_t left() const { return bytes_.size() - at_; }
  template <class Int> Int number(std::size_t offset) const { return number_at<Int>(bytes_, at_ + offset, swapped_); }
  // `expected` is a sentence about the next packet, or about the block before it.
  [[noreturn]] void damaged(const std::string& what, const std::string& value, const std::string& expected) const {
    throw InputError({name_, 0, what, value, expected});
  }
  std::string next_packet() const { return "packet " + std::to_string(capture_.packets.size() + 1); }
  void torn(const std::string& where) {
    capture_.warning = name_ + ": " + where + ": the file ends within it; everything before is read";
    at_ = bytes_.size();
  }

  Capture& capture_;
  const std::string& name_;
  const std::string_view bytes_;
  std::size_t at_ = 0;
  bool swapped_ = false;
};

void parse_pcap(Capture& capture, const std::string& name);
void parse_pcapng(Capture& capture, const std::string& name);

}  // namespace ttf::recording::capture
