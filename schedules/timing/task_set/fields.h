// The fields of one line, by the names of their columns. A wrong field is a finding with file, line, column, value and
// allowed range; its getter then returns a value inside the range, so that reading goes on.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/errors.h"
#include "core/strict_yaml.h"
#include "core/time.h"

namespace ttf::schedules::timing::task_set {

inline constexpr Duration kLongestTime = Duration::milliseconds(1'000'000);
inline constexpr Range<Duration> kPeriods{Duration::microseconds(1), kLongestTime};
inline constexpr Range<Duration> kDelays{Duration{}, kLongestTime};

class Fields {
 public:
  // Columns and findings outlive this. Missing columns at the line's end are blank.
  Fields(const std::string& file, int line, std::vector<std::string> fields, std::span<const std::string_view> columns,
         Findings& findings);

  const std::string& text(std::string_view column) const;
  bool is_blank(std::string_view column) const { return text(column).empty(); }

  // Returns a name of printable characters without ">".
  std::string name();
  // "2.5 ms"; none for a blank field.
  std::optional<Duration> duration(std::string_view column, Range<Duration> allowed);
  Duration needed_duration(std::string_view column, Range<Duration> allowed);
  std::optional<std::int64_t> integer(std::string_view column, Range<std::int64_t> allowed, std::string_view unit = "");
  // Returns the place of the field among the words.
  std::size_t choice(std::string_view column, const std::vector<std::string_view>& words);
  void must_be_blank(std::string_view column, std::string_view why);

  void fail(std::string_view column, std::string expected);
  int line() const { return line_; }

 private:
  const std::string& file_;
  int line_;
  std::vector<std::string> fields_;
  std::span<const std::string_view> columns_;
  Findings& findings_;
};

// Returns "40 ms", in the largest unit that needs no decimals.
std::string duration_words(Duration time);

}  // namespace ttf::schedules::timing::task_set
