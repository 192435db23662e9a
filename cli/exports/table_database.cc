#include "cli/exports/table_database.h"

#include <fmt/format.h>

#include <charconv>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <stdexcept>
#include <system_error>
#include <vector>

#include "cli/output.h"

namespace ttf::cli::exports {
namespace {

using experiments::results::Database;
using experiments::results::Statement;
using recording::exports::Column;
using recording::exports::ColumnType;
using recording::exports::kTableNames;
using recording::exports::Table;

constexpr std::string_view name_of(Table table) { return kTableNames[static_cast<std::size_t>(table)]; }

constexpr std::string_view type_name(ColumnType type) {
  switch (type) {
    case ColumnType::kReal: return "REAL";
    case ColumnType::kInteger: return "INTEGER";
    case ColumnType::kText: return "TEXT";
  }
  return "";
}

// Rows are found by instant and object, and by image. Returns the statement that adds a row.
std::string create(const Database& database, std::string_view name, const std::vector<Column>& columns) {
  std::string typed, key, values;
  bool of_image = false;
  for (const Column& column : columns) {
    typed += fmt::format("{}\"{}\" {}", typed.empty() ? "" : ", ", column.name, type_name(column.type));
    values += values.empty() ? "?" : ", ?";
    if (column.name == "time_s" || column.name == "object")
      key += fmt::format("{}{}", key.empty() ? "" : ", ", column.name);
    of_image = of_image || column.name == "image";
  }
  database.execute(fmt::format("CREATE TABLE {} ({})", name, typed));
  database.execute(fmt::format("CREATE INDEX {0}_by_time ON {0} ({1})", name, key));
  if (of_image) database.execute(fmt::format("CREATE INDEX {0}_by_image ON {0} (image)", name));
  return fmt::format("INSERT INTO {} VALUES ({})", name, values);
}

// Splits a line of RFC 4180. A quoted field may hold commas, quotes and line ends.
std::vector<std::string> fields_of(std::string_view line) {
  std::vector<std::string> fields(1);
  bool quoted = false;
  for (std::size_t at = 0; at + 1 < line.size(); ++at) {
    const char c = line[at];
    if (c == '"' && quoted && line[at + 1] == '"')
      fields.back() += line[at++];
    else if (c == '"')
      quoted = !quoted;
    else if (c == ',' && !quoted)
      fields.emplace_back();
    else
      fields.back() += c;
  }
  return fields;
}

template <typename Number> Number number(const std::string& field) {
  Number value{};
  std::from_chars(field.data(), field.data() + field.size(), value);
  return value;
}

void bind(Statement& insert, int at, ColumnType type, const std::string& field) {
  if (field.empty()) return insert.bind(at, std::numeric_limits<double>::quiet_NaN());
  switch (type) {
    case ColumnType::kReal: return insert.bind(at, number<double>(field));
    case ColumnType::kInteger: return insert.bind(at, number<std::int64_t>(field));
    case ColumnType::kText: return insert.bind(at, std::string_view(field));
  }
}

}  // namespace

TableDatabase::Place::Place(const std::string& name) : path(name) {
  write_file(path, "");
  if (!std::filesystem::is_regular_file(path)) throw std::runtime_error(path + ": cannot be written: is no file");
  Database::remove_beside(path);
}

TableDatabase::Place::~Place() {
  std::error_code none;
  if (!finished) std::filesystem::remove(path, none);
}

TableDatabase::Rows::Rows(const Database& database, Table table)
    : columns(recording::exports::columns(table)), insert(database, create(database, name_of(table), columns)) {}

// A file that does not stay needs no journal.
TableDatabase::TableDatabase(const std::string& path) : place_(path), database_(path, Database::Begin::kAsItIs) {
  database_.execute("PRAGMA journal_mode = OFF; PRAGMA synchronous = OFF; BEGIN");
  for (std::size_t t = 0; t < kTableNames.size(); ++t) rows_.emplace_back(database_, static_cast<Table>(t));
}

void TableDatabase::write(Table table, std::string_view line) {
  auto& [columns, insert] = rows_[static_cast<std::size_t>(table)];
  const std::vector<std::string> fields = fields_of(line);
  if (fields[0] == columns[0].name) return;  // the line of names
  for (std::size_t c = 0; c < columns.size(); ++c) bind(insert, static_cast<int>(c + 1), columns[c].type, fields.at(c));
  insert.row();
  insert.again();
}

void TableDatabase::finish() {
  database_.execute("COMMIT");
  place_.finished = true;
}

}  // namespace ttf::cli::exports
