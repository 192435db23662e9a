#include "experiments/sweep/answers/columns.h"

#include <algorithm>
#include <utility>

namespace ttf::experiments::sweep::answers {
namespace {

constexpr std::size_t kGap = 2;

std::size_t shown_width(std::string_view text) {
  return static_cast<std::size_t>(
      std::ranges::count_if(text, [](char c) { return (static_cast<unsigned char>(c) & 0xc0u) != 0x80u; }));
}

std::size_t width_of(const Column& column) {
  std::size_t width = shown_width(column.head);
  for (const std::string& cell : column.cells) width = std::max(width, shown_width(cell));
  return width;
}

std::size_t width_of(const std::vector<Column>& columns) {
  std::size_t width = 0;
  for (const Column& column : columns) width += kGap + width_of(column);
  return width;
}

std::string part_text(const std::vector<Column>& columns) {
  std::size_t rows = 0;
  for (const Column& column : columns) rows = std::max(rows, column.cells.size());
  std::vector<std::string> lines(rows + 1);
  for (const Column& column : columns) {
    const std::size_t width = width_of(column) + kGap;
    const auto add = [&](std::string& line, const std::string& cell) {
      line += cell + std::string(width - shown_width(cell), ' ');
    };
    add(lines[0], column.head);
    for (std::size_t r = 0; r < column.cells.size(); ++r) add(lines[r + 1], column.cells[r]);
  }
  std::string text;
  for (const std::string& line : lines) text += line.substr(0, line.find_last_not_of(' ') + 1) + '\n';
  return text;
}

}  // namespace

std::string in_columns(const std::vector<Column>& leading, const std::vector<std::vector<Column>>& groups) {
  const std::size_t lead = width_of(leading);
  std::vector<std::vector<Column>> pieces;  // groups, or columns of those too wide
  for (const std::vector<Column>& group : groups) {
    if (lead + width_of(group) <= kWidest + kGap)
      pieces.push_back(group);
    else
      for (const Column& column : group) pieces.push_back({column});
  }
  std::string text;
  std::vector<Column> part = leading;
  const auto end_part = [&] { text += (text.empty() ? "" : "\n") + part_text(std::exchange(part, leading)); };
  for (const std::vector<Column>& piece : pieces) {
    if (part.size() > leading.size() && width_of(part) + width_of(piece) > kWidest + kGap) end_part();
    part.insert(part.end(), piece.begin(), piece.end());
  }
  end_part();
  return text;
}

std::string wrapped(std::string_view words) {
  std::string text, line;
  while (!words.empty()) {
    const std::size_t end = std::min(words.find(' '), words.size());
    const std::string_view word = words.substr(0, end);
    words.remove_prefix(std::min(end + 1, words.size()));
    if (!line.empty() && shown_width(line) + 1 + shown_width(word) > kWidest) text += std::exchange(line, "") + '\n';
    line += (line.empty() ? "" : " ") + std::string(word);
  }
  return text + line + '\n';
}

}  // namespace ttf::experiments::sweep::answers
