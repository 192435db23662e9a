// Tables of an answer: columns side by side in at most 100 characters.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace ttf::experiments::sweep::answers {

inline constexpr std::size_t kWidest = 100;  // characters

struct Column {
  std::string head;
  std::vector<std::string> cells;
};

// Returns a table, aligned left. A table wider than kWidest goes on below itself, each part with the leading columns. The
// columns of a group stay together unless they are too wide. All columns have as many cells.
std::string in_columns(const std::vector<Column>& leading, const std::vector<std::vector<Column>>& groups);

// Returns the words in lines of at most kWidest characters, unless a word is longer.
std::string wrapped(std::string_view words);

}  // namespace ttf::experiments::sweep::answers
