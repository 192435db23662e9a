#include "recording/exports/columns.h"

#include <fmt/format.h>

#include <cmath>

namespace ttf::recording::exports {

std::string field_of(double value) { return std::isfinite(value) ? fmt::format("{}", value) : ""; }

std::string field_of(TrueTime at) {
  const bool before = at.ns < 0;
  const std::uint64_t ns = before ? ~static_cast<std::uint64_t>(at.ns) + 1 : static_cast<std::uint64_t>(at.ns);
  return fmt::format("{}{}.{:09}", before ? "-" : "", ns / 1'000'000'000, ns % 1'000'000'000);
}

std::string names_line(const std::vector<Column>& columns) {
  std::string line;
  for (const Column& column : columns) line.append(line.empty() ? "" : ",").append(column.name);
  return line;
}

}  // namespace ttf::recording::exports
