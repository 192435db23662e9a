#include "report/drawing/tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

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
    std::size_t width = shown_width(header_[c]);
    for (const auto& row : rows_) width = std::max(width, shown_width(row[c]));
    out.push_back(width);
  }
  return out;
}

std::string Table::text() const {
  const std::vector<std::size_t> width = widths();
  std::string out;
  const auto line = [&](const std::vector<std::string>& cells) {
    std::string s;
    for (std::size_t c = 0; c < cells.size(); ++c) s += (c > 0 ? "  " : "") + padded(cells[c], width[c], numeric(c));
    s.erase(s.find_last_not_of(' ') + 1);
    out += s + "\n";
  };
  line(header_);
  std::string rule;
  for (std::size_t c = 0; c < width.size(); ++c) rule += (c > 0 ? "  " : "") + std::string(width[c], '-');
  out += rule + "\n";
  for (const auto& row : rows_) line(row);
  return out;
}

std::string cell(double value, int decimals) {
  return std::isfinite(value) ? fmt::format("{:.{}f}", value, decimals) : "-";
}

}  // namespace ttf::report::drawing
