// Shared by the fuzz targets: values taken from bytes, and the form of a refusal.
//
// A target is one function of bytes, LLVMFuzzerTestOneInput, driven by libFuzzer (TTF_FUZZ, tools/fuzz.sh).
// It begins with the seeds and the committed regressions. A broken law fails a check.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>

#include "core/errors.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace ttf::fuzz {

// Takes values off the front of the input. Gives zeros once it is used up, so that every input is valid.
class Source {
 public:
  Source(const std::uint8_t* data, std::size_t size) : rest_(reinterpret_cast<const std::byte*>(data), size) {}

  bool empty() const { return rest_.empty(); }
  template <class Int> Int take() {
    Int value{};
    const std::span<const std::byte> field = bytes(sizeof(Int));
    std::memcpy(&value, field.data(), field.size());
    return value;
  }
  // A number in 0..limit - 1.
  std::size_t below(std::size_t limit) { return take<std::uint16_t>() % limit; }
  // At most `count` bytes.
  std::span<const std::byte> bytes(std::size_t count) {
    const std::span<const std::byte> taken = rest_.first(count < rest_.size() ? count : rest_.size());
    rest_ = rest_.subspan(taken.size());
    return taken;
  }
  std::span<const std::byte> rest() const { return rest_; }

 private:
  std::span<const std::byte> rest_;
};

inline std::string text_of(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

// A refusal has findings, each in one printable line that begins with the file's name.
void check_refusal(const InputError& error, std::string_view file);
// The same for warnings, of which there may be zero.
void check_lines(std::string_view text, std::string_view file);

// Returns whether `read` accepted its input. InputError is the only other way out, and must have the proper
// form.
template <class Read> bool accepted(std::string_view file, Read&& read) {
  try {
    read();
    return true;
  } catch (const InputError& error) {
    check_refusal(error, file);
    return false;
  }
}

// A shipped file, by its path from the project's folder.
std::string shipped(const std::string& path);
// A shipped cluster's whole text: its file may extend another.
std::string shipped_cluster(const std::string& name);

}  // namespace ttf::fuzz
