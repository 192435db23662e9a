#include "report/drawing/tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "core/check.h"

namespace ttf::report::drawing {
namespace {

std::size_t shown_width(std::string_view s) {
  return static_cast<std::size_t>(
      std::ranges::count_if(s, [](char c) { return (static_cast<unsigned char>(c) & 0xc0u) != 0x80u; }));
}

std::string padded(const std::string& s, std::size_t width, bool right) {
  const std::string blanks(width - std::min(width, shown_width(s)), ' ');
  return right ? blanks + s : s + blanks;
}

const std::string kGap = "  ";

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::size_t begin = 0;
  for (std::size_t end = text.find('\n'); end != std::string::npos; end = text.find('\n', begin)) {
    lines.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  lines.push_back(text.substr(begin));
  return lines;
}

// Returns the words in lines of at most `most` characters, each behind four blanks; "" for no words.
std::string indented(std::string_view words, std::size_t most) {
  const std::string margin(4, ' ');
  std::string out, line;
  while (!words.empty()) {
    const std::size_t end = std::min(words.find(' '), words.size());
    const std::string word(words.substr(0, end));
    words.remove_prefix(std::min(end + 1, words.size()));
    if (!line.empty() && margin.size() + shown_width(line) + 1 + shown_width(word) > most)
      out += margin + std::exchange(line, "") + "\n";
    line += (line.empty() ? "" : " ") + word;
  }
  return line.empty() ? out : out + margin + line + "\n";
}

bool is_number(const std::string& s) {
  if (s.empty() || s == "-") return true;
  char* end = nullptr;
  std::strtod(s.c_str(), &end);
  return end != s.c_str() && (*end == '\0' || std::string_view(end) == "%");
}

}  // namespace

void Table::add(std::vector<std::string> row) {
  TTF_CHECK(row.size() <= header_.size(), "{} cells in a table of {} columns", row.size(), header_.size());
  row.resize(header_.size());
  rows_.push_back(std::move(row));
}

bool Table::numeric(std::size_t column) const {
  return !rows_.empty() && std::ranges::all_of(rows_, [&](const auto& row) { return is_number(row[column]); });
}

std::vector<std::size_t> Table::widths() const {
  std::vector<std::size_t> out;
  for (std::size_t c = 0; c < header_.size(); ++c) {
    std::size_t width = 0;
    for (const std::string& line : lines_of(header_[c])) width = std::max(width, shown_width(line));
    for (const auto& row : rows_) width = std::max(width, shown_width(row[c]));
    out.push_back(width);
  }
  return out;
}

// Returns the columns of each part, the first column in all of them.
std::vector<std::vector<std::size_t>> Table::parts(const std::vector<std::size_t>& width) const {
  const auto wide = [&](const std::vector<std::size_t>& columns) {
    std::size_t sum = width[0];
    for (const std::size_t column : columns) sum += kGap.size() + width[column];
    return sum;
  };
  std::vector<std::vector<std::size_t>> groups;
  for (std::size_t c = 1; c < width.size(); ++c) {
    if (c == 1 || groups_.empty() || std::ranges::find(groups_, c) != groups_.end()) groups.emplace_back();
    groups.back().push_back(c);
  }
  std::vector<std::vector<std::size_t>> pieces;  // groups, or columns of those too wide
  for (std::vector<std::size_t>& group : groups) {
    if (wide(group) <= kWidest)
      pieces.push_back(std::move(group));
    else
      for (const std::size_t column : group) pieces.push_back({column});
  }
  std::vector<std::vector<std::size_t>> parts{{}};
  for (const std::vector<std::size_t>& piece : pieces) {
    std::vector<std::size_t> longer = parts.back();
    longer.insert(longer.end(), piece.begin(), piece.end());
    if (parts.back().empty() || wide(longer) <= kWidest)
      parts.back() = std::move(longer);
    else
      parts.push_back(piece);
  }
  for (std::vector<std::size_t>& part : parts) part.insert(part.begin(), 0);
  return parts;
}

std::string Table::part_text(const std::vector<std::size_t>& columns, const std::vector<std::size_t>& width,
                             bool words_below) const {
  std::string out;
  const auto line = [&](const auto& cell_of) {
    std::string s;
    for (const std::size_t c : columns) s += (c == 0 ? "" : kGap) + padded(cell_of(c), width[c], numeric(c));
    s.erase(s.find_last_not_of(' ') + 1);
    out += s + "\n";
  };
  std::size_t heads = 1;
  for (const std::size_t c : columns) heads = std::max(heads, lines_of(header_[c]).size());
  for (std::size_t h = 0; h < heads; ++h)
    line([&](std::size_t c) {
      const std::vector<std::string> lines = lines_of(header_[c]);
      return h + lines.size() < heads ? std::string() : lines[h + lines.size() - heads];
    });
  std::string rule;
  for (const std::size_t c : columns) rule += (c == 0 ? "" : kGap) + std::string(width[c], '-');
  const auto below = [&](const std::string& words) {
    if (words_below) out += indented(words, kWidest);
  };
  below(header_.back());
  out += rule + "\n";
  for (const auto& row : rows_) {
    line([&](std::size_t c) { return row[c]; });
    below(row.back());
  }
  return out;
}

std::string Table::text() const {
  std::vector<std::size_t> width = widths();
  std::size_t whole = 0;
  for (const std::size_t column : width) whole += column + (whole == 0 ? 0 : kGap.size());
  const bool words_below = words_ && whole > kWidest;
  if (words_below) width.pop_back();
  const std::vector<std::vector<std::size_t>> all = parts(width);
  std::string out;
  for (const std::vector<std::size_t>& part : all)
    out += (out.empty() ? "" : "\n") + part_text(part, width, words_below && &part == &all.back());
  return out;
}

std::string cell(double value, int decimals) {
  return std::isfinite(value) ? fmt::format("{:.{}f}", value, decimals) : "-";
}

}  // namespace ttf::report::drawing
