// Tables for people: aligned text from a header and rows.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace ttf::report::drawing {

// Numeric columns are aligned right, others left; empty cells and "-" count as numeric. Widths count UTF-8
// characters. A short row is filled with empty cells; a row longer than the header is our bug.
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

// Returns a value with `decimals` decimals, or "-" if it is not finite.
std::string cell(double value, int decimals);

}  // namespace ttf::report::drawing
