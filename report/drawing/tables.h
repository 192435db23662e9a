// Tables for people: aligned text from a header and rows.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace ttf::report::drawing {

// Numeric columns are aligned right, others left; empty cells and "-" count as numeric. Widths count UTF-8
// characters. A short row is filled with empty cells; a row longer than the header is our bug. A cell of the header may
// have several lines: the last ones stand side by side.
//
// A table wider than kWidest goes on below itself: each part begins with the first column. Columns of a group stay together,
// if they fit. A last column of words goes below each row instead.
class Table {
 public:
  static constexpr std::size_t kWidest = 100;  // characters

  explicit Table(std::vector<std::string> header) : header_(std::move(header)) {}
  void add(std::vector<std::string> row);
  // The columns from here on, up to the next group, are a group. Without any, each column is one.
  void begin_group(std::size_t column) { groups_.push_back(column); }
  // The last column has words, not values.
  void end_in_words() { words_ = true; }
  std::size_t rows() const { return rows_.size(); }
  std::string text() const;

 private:
  bool numeric(std::size_t column) const;
  std::vector<std::size_t> widths() const;
  std::vector<std::vector<std::size_t>> parts(const std::vector<std::size_t>& width) const;
  std::string part_text(const std::vector<std::size_t>& columns, const std::vector<std::size_t>& width,
                        bool words_below) const;

  std::vector<std::string> header_;
  std::vector<std::vector<std::string>> rows_;
  std::vector<std::size_t> groups_;
  bool words_ = false;
};

// Returns a value with `decimals` decimals, or "-" if it is not finite.
std::string cell(double value, int decimals);

}  // namespace ttf::report::drawing
