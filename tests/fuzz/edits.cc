#include "tests/fuzz/edits.h"

#include <algorithm>

namespace ttf::fuzz {
namespace {

std::string_view take_line(std::string_view& text) {
  const std::size_t end = text.find('\n');
  const std::string_view line = text.substr(0, end);
  text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  return line;
}

std::string_view take_word(std::string_view& line) {
  const std::size_t end = line.find(' ');
  const std::string_view word = line.substr(0, end);
  line.remove_prefix(end == std::string_view::npos ? line.size() : end + 1);
  return word;
}

std::size_t small_number(std::string_view digits) {
  std::size_t number = 0;
  for (const char c : digits.substr(0, 4))
    if (c >= '0' && c <= '9') number = number * 10 + static_cast<std::size_t>(c - '0');
  return number;
}

bool of_a_name(char c) {
  return (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || c == '_';
}

// Returns the beginning of the value after the occurrence-th "key:", or npos.
std::size_t value_of(std::string_view text, std::string_view key, std::size_t occurrence) {
  const std::string wanted = std::string(key) + ":";
  for (std::size_t at = text.find(wanted); at != std::string_view::npos; at = text.find(wanted, at + 1)) {
    if (at > 0 && of_a_name(text[at - 1])) continue;
    if (occurrence-- == 0) return at + wanted.size();
  }
  return std::string_view::npos;
}

// Returns the end of a value on its line: lists and mappings in brackets are values, too.
std::size_t end_of_value(std::string_view text, std::size_t at) {
  int depth = 0;
  for (; at < text.size() && text[at] != '\n'; ++at) {
    if (text[at] == '[' || text[at] == '{') ++depth;
    if (text[at] == ']' || text[at] == '}') --depth;
    if (depth < 0 || (depth == 0 && text[at] == ',')) break;
  }
  return at;
}

}  // namespace

std::string edited(std::span<const Shipped> files, std::string_view edits) {
  const std::string_view name = take_line(edits);
  const auto named = std::find_if(files.begin(), files.end(), [&](const Shipped& file) { return file.name == name; });
  std::string text = (named == files.end() ? files.front() : *named).text;
  while (!edits.empty()) {
    std::string_view line = take_line(edits);
    std::string_view key = take_word(line);
    const bool drop = key == "-", repeat = key == "+";
    if (drop || repeat) key = take_word(line);
    if (key.empty()) continue;
    const std::size_t value = value_of(text, key, small_number(take_word(line)));
    if (value == std::string::npos) continue;
    if (!drop && !repeat) {
      text.replace(value, end_of_value(text, value) - value, " " + std::string(line));
      continue;
    }
    const std::size_t before = text.rfind('\n', value), start = before == std::string::npos ? 0 : before + 1;
    const std::size_t end = std::min(text.find('\n', value), text.size() - 1) + 1;
    if (repeat)
      text.insert(start, text.substr(start, end - start));
    else
      text.erase(start, end - start);
  }
  return text;
}

}  // namespace ttf::fuzz
