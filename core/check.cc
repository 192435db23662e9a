#include "core/check.h"

#include <array>
#include <charconv>
#include <cstdio>
#include <cstdlib>

namespace ttf {
namespace {

// Returns the shortest decimal that reads back as the same value.
std::string shortest(double value) {
  std::array<char, 32> digits{};
  const auto [end, error] = std::to_chars(digits.data(), digits.data() + digits.size(), value);
  return {digits.data(), end};
}

}  // namespace

CheckedValue::CheckedValue(double value) : text_(shortest(value)) {}

void check_failed(const char* file, int line, const char* condition, std::string_view text,
                  std::initializer_list<CheckedValue> values) {
  std::string message = std::string(file) + ':' + std::to_string(line) + ": check failed: " + condition + " (";
  for (const CheckedValue& value : values) {
    const std::size_t place = text.find("{}");
    message += text.substr(0, place);
    message += value.text();
    text.remove_prefix(place + 2);
  }
  message += text;
  message += ")\n";
  std::fputs(message.c_str(), stderr);
  std::abort();
}

}  // namespace ttf
