// Where the lines of a text come from that was put together from several files.
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "core/errors.h"

namespace ttf {

struct TextPlace {
  std::string file;
  int line = 0;  // 1-based; 0: the file as a whole
};

class TextOrigins {
 public:
  TextOrigins() = default;
  explicit TextOrigins(std::vector<std::string> files) : files_(std::move(files)) {}

  // The file that was asked for, and its line that leads to the others.
  void set_heir(TextPlace heir) { heir_ = std::move(heir); }

  // The text's next line is line `line` of the file with that index.
  void add(std::size_t file, int line) { lines_.emplace_back(file, line); }
  // A new line stands before line `at` of the text. Its origin is that of line `at`.
  void insert(int at) {
    if (has(at)) lines_.insert(lines_.begin() + (at - 1), lines_[static_cast<std::size_t>(at) - 1]);
  }
  // Returns the origin of a line of the text. A text that is one file's own has no origins: its lines are those of
  // `name`.
  TextPlace place(const std::string& name, int line) const {
    if (!has(line)) return {name, line};
    const auto& [file, there] = lines_[static_cast<std::size_t>(line) - 1];
    return {files_[file], there};
  }
  // Returns a finding about the text with the file and line from which its line came.
  Finding moved(Finding finding) const;
  // Returns the finding. One in another file than the heir names the heir's line, too.
  Finding with_heir(Finding finding) const;

 private:
  bool has(int line) const { return line > 0 && static_cast<std::size_t>(line) <= lines_.size(); }

  std::vector<std::string> files_;
  std::vector<std::pair<std::size_t, int>> lines_;
  TextPlace heir_;  // without a file: the text is one file's own
};

}  // namespace ttf
