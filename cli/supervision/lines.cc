#include "cli/supervision/lines.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "core/utf8.h"

namespace ttf::cli::supervision {
namespace {

constexpr unsigned char byte_of(char c) { return static_cast<unsigned char>(c); }
constexpr bool is_continuation(char c) { return (byte_of(c) & 0xc0u) == 0x80u; }

// Returns the length of the printable character that begins `text`; 0 otherwise. C1 controls (U+0080..U+009F) are
// excluded, because terminals obey them.
std::size_t character(std::string_view text) {
  const unsigned char lead = byte_of(text[0]);
  if (lead < 0x20 || lead == 0x7f || (lead == 0xc2 && text.size() > 1 && byte_of(text[1]) < 0xa0)) return 0;
  return utf8_length(text);
}

// Returns the length of the first piece of a long line, without splitting a character.
std::size_t cut_of(std::string_view text) {
  std::size_t cut = kLongestLine;
  while (cut > kLongestLine - 4 && is_continuation(text[cut])) --cut;
  return is_continuation(text[cut]) ? kLongestLine : cut;
}

}  // namespace

std::vector<std::string> LineCutter::feed(std::string_view bytes) {
  std::vector<std::string> lines;
  const auto shorten = [&] {
    while (held_.size() > kLongestLine) {
      const std::size_t cut = cut_of(held_);
      lines.push_back(held_.substr(0, cut).append(kGoesOn));
      held_.erase(0, cut);
    }
  };
  while (!bytes.empty()) {
    // Takes one piece at a time, so that erasing at the front stays cheap.
    const std::string_view part = bytes.substr(0, kLongestLine);
    const std::size_t end = part.find('\n');
    held_ += part.substr(0, end);
    bytes.remove_prefix(end == std::string_view::npos ? part.size() : end + 1);
    shorten();
    if (end == std::string_view::npos) continue;
    if (held_.ends_with('\r')) held_.pop_back();
    lines.push_back(std::move(held_));
    held_.clear();
  }
  return lines;
}

std::vector<std::string> LineCutter::finish() {
  std::vector<std::string> lines;
  if (!held_.empty()) lines.push_back(std::move(held_));
  held_.clear();
  return lines;
}

std::string printable(std::string_view line) {
  std::string out;
  out.reserve(line.size());
  while (!line.empty()) {
    if (const std::size_t length = line[0] == '\t' ? 1 : character(line); length > 0) {
      out += line.substr(0, length);
      line.remove_prefix(length);
    } else {
      out += fmt::format("\\x{:02x}", byte_of(line[0]));
      line.remove_prefix(1);
    }
  }
  return out;
}

std::size_t shown_width(std::string_view text) {
  return static_cast<std::size_t>(std::ranges::count_if(text, [](char c) { return !is_continuation(c); }));
}

std::string prefixed(Duration since_launch, const Speaker& speaker, std::size_t width, bool colour,
                     std::string_view text) {
  // Cyan, green, yellow, blue, magenta, and their bright variants; red is for failures.
  constexpr std::array<int, 10> kColours{36, 32, 33, 34, 35, 96, 92, 93, 94, 95};
  const std::size_t shown = shown_width(speaker.name);
  const std::string front = fmt::format("{:8.3f} {}{} |", since_launch.seconds(), speaker.name,
                                        std::string(width - std::min(width, shown), ' '));
  const std::string_view gap = text.empty() ? "" : " ";
  if (!colour) return fmt::format("{}{}{}", front, gap, text);
  return fmt::format("\x1b[{}m{}\x1b[0m{}{}", kColours[speaker.index % kColours.size()], front, gap, text);
}

}  // namespace ttf::cli::supervision
