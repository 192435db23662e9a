// Tables for people: aligned text from a header and rows.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace ttf::report::drawing {

// Columns whose cells are all numbers (or empty or "-") are aligned right, others left. Widths count UTF-8
// characters. A row with fewer cells than the header is filled with empty ones; one with more is our bug.
class Table {
 public:
  explicit Table(std::vector<std::string> header) : header_(std::move(header)) {}
  void add(std::vector<std::string> row);
  std::size_t rows() const { return rows_.size(); }
  std::string text() const;

 private:
  bool numeric(std::size_t column) const;
  std::vector<std::size_t> widths() const;

  std::vector<std::string> header_;
  std::vector<std::vector<std::string>> rows_;
};

// A value with `decimals` decimals, "-" for what is not finite.
std::string cell(double value, int decimals);

}  // namespace ttf::report::drawing
