#include "core/csv.h"

#include <algorithm>

namespace ttf {
namespace {

constexpr std::string_view kBlanks = " \t";

std::string_view without_blanks(std::string_view text) {
  const std::size_t first = text.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

// Takes a quoted field off the front, with the blanks after it; returns false if the closing quote is missing.
bool take_quoted(std::string_view& line, std::string& field) {
  for (std::size_t at = 1; at < line.size(); ++at) {
    if (line[at] != '"') {
      field += line[at];
    } else if (at + 1 < line.size() && line[at + 1] == '"') {
      field += line[at++];
    } else {
      line.remove_prefix(at + 1);
      line.remove_prefix(std::min(line.find_first_not_of(kBlanks), line.size()));
      return true;
    }
  }
  return false;
}

}  // namespace

CsvLines::CsvLines(std::string_view text) : rest_(text) {
  constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
  if (rest_.substr(0, kByteOrderMark.size()) == kByteOrderMark) rest_.remove_prefix(kByteOrderMark.size());
}

bool CsvLines::next() {
  while (!rest_.empty()) {
    const std::size_t end = rest_.find('\n');
    std::string_view line = rest_.substr(0, end);
    rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
    ++line_;
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    line = without_blanks(line);
    if (line.empty() || line.front() == '#') continue;
    split(line);
    return true;
  }
  return false;
}

void CsvLines::split(std::string_view line) {
  fields_.clear();
  broken_ = {};
  while (true) {
    line.remove_prefix(std::min(line.find_first_not_of(kBlanks), line.size()));
    std::string& field = fields_.emplace_back();
    if (!line.empty() && line.front() == '"') {
      if (!take_quoted(line, field)) {
        broken_ = "must end its quoted field on the same line";
        return;
      }
      if (!line.empty() && line.front() != ',') {
        broken_ = "must have a comma after a quoted field";
        return;
      }
    } else {
      const std::size_t comma = std::min(line.find(','), line.size());
      field = without_blanks(line.substr(0, comma));
      line.remove_prefix(comma);
    }
    if (line.empty()) return;
    line.remove_prefix(1);
  }
}

std::string csv_field(std::string_view text) {
  const bool plain = text.find_first_of("\",\r\n") == std::string_view::npos && without_blanks(text) == text &&
                     (text.empty() || text.front() != '#');
  if (plain) return std::string(text);
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"') quoted += '"';
    quoted += c;
  }
  return quoted + '"';
}

}  // namespace ttf
