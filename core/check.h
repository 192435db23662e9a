// Always-on checks for our own bugs: a failed one prints its values and stops the process. Bad input throws
// instead (core/errors.h); the faults of a network are enum values and counted.
//
// The standard library alone formats the values. fusion/ includes this header, and needs no other library than Eigen.
#pragma once

#include <concepts>
#include <cstddef>
#include <initializer_list>
#include <string>
#include <string_view>

namespace ttf {

// A value of a failed check, as text.
class CheckedValue {
 public:
  CheckedValue(bool value) : text_(value ? "true" : "false") {}
  CheckedValue(std::integral auto value) : text_(std::to_string(value)) {}
  CheckedValue(double value);
  CheckedValue(std::string_view value) : text_(value) {}
  CheckedValue(const std::string& value) : text_(value) {}
  CheckedValue(const char* value) : text_(value) {}
  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

// A text with one {} for each of `Count` values; the compiler counts them.
template <std::size_t Count> struct CheckedText {
  std::string_view text;

  consteval CheckedText(const char* literal) : text(literal) {
    std::size_t places = 0;
    for (std::size_t at = text.find("{}"); at != std::string_view::npos; at = text.find("{}", at + 2)) ++places;
    if (places != Count) throw "a check has one {} for each value";  // no constant, so it does not compile
  }
};

[[noreturn]] void check_failed(const char* file, int line, const char* condition, std::string_view text,
                               std::initializer_list<CheckedValue> values);

template <class... Values>
[[noreturn]] void check_failed(const char* file, int line, const char* condition, CheckedText<sizeof...(Values)> text,
                               const Values&... values) {
  check_failed(file, line, condition, text.text, {CheckedValue(values)...});
}

}  // namespace ttf

// TTF_CHECK(slot < slots, "slot {} of {}", slot, slots)
#define TTF_CHECK(condition, ...)                                          \
  do {                                                                     \
    if (!(condition)) [[unlikely]]                                         \
      ::ttf::check_failed(__FILE__, __LINE__, #condition, "" __VA_ARGS__); \
  } while (false)
