#include "core/errors.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <string_view>

namespace ttf {
namespace {

std::string all_sentences(const std::vector<Finding>& findings) {
  std::string text;
  for (const Finding& finding : findings) {
    if (!text.empty()) text += '\n';
    text += finding.sentence();
  }
  return text;
}

// Makes text from outside safe for one line of a message. Control characters become \xNN, and the text is cut to
// `most` bytes (between characters of UTF-8).
std::string shown(std::string_view text, std::size_t most) {
  std::size_t end = std::min(most, text.size());
  while (end < text.size() && end > 0 && (static_cast<unsigned char>(text[end]) & 0xc0) == 0x80) --end;
  std::string out;
  for (const char c : text.substr(0, end)) {
    const auto code = static_cast<unsigned char>(c);
    if (code < 0x20 || code == 0x7f)
      out += fmt::format("\\x{:02x}", code);
    else
      out += c;
  }
  return end < text.size() ? out + "..." : out;
}

constexpr std::size_t kWhole = std::string_view::npos;
constexpr std::size_t kMostKey = 200, kMostValue = 100;

}  // namespace

std::string Finding::sentence() const {
  std::string text = file.empty() ? "input" : shown(file, kWhole);
  if (line > 0) text += fmt::format(":{}", line);
  text += ": ";
  if (!key.empty()) text += shown(key, kMostKey);
  if (!value.empty()) text += fmt::format("{}{}", key.empty() ? "" : " = ", shown(value, kMostValue));
  if (!key.empty() || !value.empty()) text += ": ";
  return text + shown(expected, kWhole);
}

InputError::InputError(std::vector<Finding> findings)
    : std::runtime_error(all_sentences(findings)), findings_(std::move(findings)) {}

void Findings::throw_if_any() const {
  if (!list_.empty()) throw InputError(list_);
}

std::string system_message(int error) {
  const char* const words = strerrordesc_np(error);  // a constant
  return words != nullptr ? words : fmt::format("Unknown error {}", error);
}

}  // namespace ttf
