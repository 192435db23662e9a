// Plain CDR as ROS 2 has it on the wire (OMG CDR, little endian; DDSI-RTPS 2.3, 10.5), written by hand. It
// gives a message's expected bytes independently of the code under test.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string_view>
#include <vector>

namespace ttf::bus::dds::ros {

class Cdr {
 public:
  template <class Number> Cdr& put(Number number) {
    while (bytes_.size() % sizeof number != 0) bytes_.push_back(0);  // aligned to its size, from the payload's begin
    const std::size_t at = bytes_.size();
    bytes_.resize(at + sizeof number);
    std::memcpy(bytes_.data() + at, &number, sizeof number);
    return *this;
  }
  Cdr& u8(std::uint8_t value) { return put(value); }
  Cdr& u16(std::uint16_t value) { return put(value); }
  Cdr& u32(std::uint32_t value) { return put(value); }
  Cdr& i32(std::int32_t value) { return put(value); }
  Cdr& f64(double value) { return put(value); }
  Cdr& text(std::string_view text) {
    u32(static_cast<std::uint32_t>(text.size() + 1));
    bytes_.insert(bytes_.end(), text.begin(), text.end());
    bytes_.push_back(0);
    return *this;
  }
  Cdr& time(std::int32_t seconds, std::uint32_t nanoseconds) { return i32(seconds).u32(nanoseconds); }
  const std::vector<std::uint8_t>& bytes() const { return bytes_; }

 private:
  std::vector<std::uint8_t> bytes_;
};

}  // namespace ttf::bus::dds::ros
