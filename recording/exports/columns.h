// The columns of a table of comma-separated text (RFC 4180). One list has them in order. Each row of the list is a column: its
// name, and its value of a row of the table. The column has the value's type.
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "core/csv.h"
#include "core/time.h"

namespace ttf::recording::exports {

enum class ColumnType : std::uint8_t { kReal, kInteger, kText };
struct Column {
  std::string_view name;
  ColumnType type = ColumnType::kReal;
};

// Returns a value as a field. Numbers read back equal. An instant is in exact seconds. A truth value is 0 or 1. An absent
// value is empty, and so is a number that is not finite.
std::string field_of(double value);
std::string field_of(TrueTime at);
inline std::string field_of(std::string_view text) { return csv_field(text); }
template <std::integral Number> std::string field_of(Number value) { return std::to_string(value); }
template <class Value> std::string field_of(const std::optional<Value>& value) {
  return value ? field_of(*value) : std::string();
}

template <class Value> inline constexpr ColumnType kTypeOf = ColumnType::kText;
template <> inline constexpr ColumnType kTypeOf<double> = ColumnType::kReal;
template <> inline constexpr ColumnType kTypeOf<TrueTime> = ColumnType::kReal;
template <std::integral Number> inline constexpr ColumnType kTypeOf<Number> = ColumnType::kInteger;
template <class Value> inline constexpr ColumnType kTypeOf<std::optional<Value>> = kTypeOf<Value>;

// A column of a table whose rows are made from `Row`. The value is a function without captures.
template <class Row> struct ColumnOf {
  template <class Value>
  constexpr ColumnOf(std::string_view name, Value)
      : column{name, kTypeOf<std::remove_cvref_t<std::invoke_result_t<Value, const Row&>>>},
        field([](const Row& row) { return field_of(Value{}(row)); }) {}

  Column column;
  std::string (*field)(const Row&);
};

template <class Row, std::size_t count> std::vector<Column> columns_of(const ColumnOf<Row> (&list)[count]) {
  std::vector<Column> columns;
  for (const ColumnOf<Row>& one : list) columns.push_back(one.column);
  return columns;
}
// Return a line without its end: the names, and the fields of a row.
std::string names_line(const std::vector<Column>& columns);
template <class Row, std::size_t count> std::string fields_line(const ColumnOf<Row> (&list)[count], const Row& row) {
  std::string line = list[0].field(row);
  for (std::size_t c = 1; c < count; ++c) line.append(",").append(list[c].field(row));
  return line;
}

}  // namespace ttf::recording::exports
