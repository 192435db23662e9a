// A page that lists the pictures and tables of a folder. It refers only to the files beside it.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace ttf::report::page {

// One section; every part may be empty. `picture` and `more` are file names inside the folder. `more` holds
// the same picture in other formats, the log, and so on.
struct IndexEntry {
  std::string heading;
  std::string picture;
  std::string caption;
  std::string preformatted;  // a text table
  std::vector<std::string> more;
};

// Writes `dir`/index.html. Throws std::runtime_error if it cannot.
void write_index(const std::string& dir, std::string_view title, std::span<const IndexEntry> entries);
// Returns the same page as a string.
std::string index_html(std::string_view title, std::span<const IndexEntry> entries);

}  // namespace ttf::report::page
