// Reads comma-separated text line by line (RFC 4180, but no line ends within quotes).
//
// A byte order mark and Windows line ends are accepted. The last line needs no end. Empty lines and lines that begin
// with # are ignored. So are blanks around an unquoted field.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace ttf {

class CsvLines {
 public:
  // `text` must outlive the reader.
  explicit CsvLines(std::string_view text);

  // Advances to the next line with fields; returns false at the end.
  bool next();
  int line() const { return line_; }
  const std::vector<std::string>& fields() const { return fields_; }
  // Returns the rule that the line breaks, as a sentence with "must"; empty for a sound line.
  std::string_view broken() const { return broken_; }

 private:
  void split(std::string_view line);

  std::string_view rest_;
  int line_ = 0;
  std::vector<std::string> fields_;
  std::string_view broken_;
};

// Writes a field, with quotes if it could not be read back without.
std::string csv_field(std::string_view text);

}  // namespace ttf
