// Comma-separated text, line by line (RFC 4180, but for line ends within quotes, which nothing here needs).
//
// A byte order mark at the beginning, line ends of Windows and a last line without an end are fine; empty lines and
// those that begin with # are passed over. Blanks around a field without quotes do not count.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace ttf::recording::rows {

class CsvLines {
 public:
  // The text must outlive it.
  explicit CsvLines(std::string_view text);

  // To the next line with something on it; false at the end.
  bool next();
  int line() const { return line_; }
  const std::vector<std::string>& fields() const { return fields_; }
  // Why the line is no list of fields, as what is expected; empty where it is one.
  std::string_view broken() const { return broken_; }

 private:
  void split(std::string_view line);

  std::string_view rest_;
  int line_ = 0;
  std::vector<std::string> fields_;
  std::string_view broken_;
};

// A field as it is written: in quotes where it would not be read again without.
std::string csv_field(std::string_view text);

}  // namespace ttf::recording::rows
