// The columns of a file of signals, by the names of its heading.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/csv.h"
#include "core/errors.h"
#include "core/strict_yaml.h"
#include "core/time.h"

namespace ttf::cli::schedule::packing {

enum Column : std::size_t {
  kSignal,
  kNode,
  kPeriod,
  kRelease,
  kDeadline,
  kBits,
  kVariants,
  kSlot,
  kFirstCycle,
  kBitOffset,
  kChannel,
  kColumns
};
inline constexpr std::array<std::string_view, kColumns> kColumnNames{
    "signal",   "node", "period_ms",   "release_ms", "deadline_ms", "bits",
    "variants", "slot", "first_cycle", "bit_offset", "channel"};

// One line after the other, with its fields by column.
class Rows {
 public:
  // Throws InputError if the heading has an unknown column, one twice, or not those that are `needed`.
  Rows(std::string_view text, const std::string& name, const std::vector<Column>& needed);

  // Advances to the next sound line. A line that is not adds a finding.
  bool next(Findings& findings);
  int line() const { return lines_.line(); }

  // Returns an empty text for an absent column.
  const std::string& text(Column column) const;
  // Return the number, or none and a finding if it is not in the range. `empty` is the value of an empty field.
  std::optional<int> whole(Column column, Range<int> allowed, Findings& findings) const;
  std::optional<Duration> milliseconds(Column column, Range<Duration> allowed, std::optional<Duration> empty,
                                       Findings& findings) const;
  Finding finding(Column column, std::string expected) const;

 private:
  CsvLines lines_;
  std::string name_;
  std::array<std::optional<std::size_t>, kColumns> at_;
  std::size_t columns_ = 0;
};

}  // namespace ttf::cli::schedule::packing
