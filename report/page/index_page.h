// A page that lists the pictures and tables of a folder; it needs nothing but the files beside it.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace ttf::report::page {

// One section. Every part may be empty. `picture` and `more` are file names inside the folder (more: the same
// picture in other formats, the log, ...).
struct IndexEntry {
  std::string heading;
  std::string picture;
  std::string caption;
  std::string preformatted;  // a text table
  std::vector<std::string> more;
};

// Writes `dir`/index.html. Throws std::runtime_error if it cannot.
void write_index(const std::string& dir, std::string_view title, std::span<const IndexEntry> entries);
// The same page as a string.
std::string index_html(std::string_view title, std::span<const IndexEntry> entries);

}  // namespace ttf::report::page
