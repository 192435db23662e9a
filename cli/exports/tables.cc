#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <limits>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "cli/drive_progress.h"
#include "cli/exports/formats.h"
#include "cli/exports/reported_uses.h"
#include "cli/output.h"
#include "experiments/results/database.h"
#include "recording/exports/frames.h"
#include "recording/exports/tables.h"
#include "recording/records/tee.h"

namespace ttf::cli::exports {
namespace {

using experiments::results::Database;
using experiments::results::Statement;
using recording::exports::Column;
using recording::exports::ColumnType;
using recording::exports::kTableNames;
using recording::exports::Table;
using recording::exports::TableExport;

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

// The tables of a drive in one SQLite file, with the names, columns and values of its CSV files; an empty field is NULL.
// The file exists only once it is finished. An older file of its name is gone from the start. All functions throw
// std::runtime_error.
class TableDatabase {
 public:
  // A file that does not stay needs no journal.
  explicit TableDatabase(const std::string& path) : place_(path), database_(path, Database::Begin::kAsItIs) {
    database_.execute("PRAGMA journal_mode = OFF; PRAGMA synchronous = OFF; BEGIN");
    for (std::size_t t = 0; t < kTableNames.size(); ++t) rows_.emplace_back(database_, static_cast<Table>(t));
  }

  // Takes the lines of TableExport.
  void write(Table table, std::string_view line) {
    auto& [columns, insert] = rows_[static_cast<std::size_t>(table)];
    const std::vector<std::string> fields = fields_of(line);
    if (fields[0] == columns[0].name) return;  // the line of names
    for (std::size_t c = 0; c < columns.size(); ++c)
      bind(insert, static_cast<int>(c + 1), columns[c].type, fields.at(c));
    insert.row();
    insert.again();
  }
  void finish() {
    database_.execute("COMMIT");
    place_.finished = true;
  }

 private:
  // An empty file, which does not stay unless it is finished.
  struct Place {
    explicit Place(const std::string& name) : path(name) {
      write_file(path, "");
      if (!std::filesystem::is_regular_file(path)) throw std::runtime_error(path + ": cannot be written: is no file");
      Database::remove_beside(path);
    }
    ~Place() {
      std::error_code none;
      if (!finished) std::filesystem::remove(path, none);
    }
    Place(const Place&) = delete;
    Place& operator=(const Place&) = delete;
    std::string path;
    bool finished = false;
  };

  Place place_;
  Database database_;
  struct Rows {
    Rows(const Database& database, Table table)
        : columns(recording::exports::columns(table)), insert(database, create(database, name_of(table), columns)) {}
    std::vector<Column> columns;
    Statement insert;
  };
  std::deque<Rows> rows_;  // by table
};

TableRows write_tables(const recording::merge::MergedLogs& drive, TableExport::Write write) {
  TableExport tables(recording::exports::LogNames(drive.manifest()), std::move(write));
  ReportedUses uses(
      [&](const ReportedUses::Use& use, ReportedUses::Ages ages) {
        for (const evaluation::accuracy::SensorAge& one : ages)
          tables.age(use.stamp.true_time, use.image_sequence, one.sensor, one.age);
      },
      [&](const evaluation::accuracy::JudgedUse& use) {
        constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
        for (const evaluation::accuracy::UsedObject& one : use.objects)
          tables.error({use.at, one.object, one.error,
                        one.belief ? one.belief->sigma : std::array{kUnknown, kUnknown, kUnknown, kUnknown},
                        one.box.heading_rad, one.box.length_m, one.box.width_m,
                        one.belief ? one.belief->nees : kUnknown});
      });
  recording::exports::FrameCollector frames;
  recording::records::Tee all({&tables, &uses, &frames});
  read_shown(drive, all);
  uses.finish();
  tables.frames(frames);
  TableRows rows;
  for (const std::string_view name : recording::exports::kTableNames)
    rows.emplace_back(name, tables.rows()[rows.size()]);
  return rows;
}

}  // namespace

TableRows export_tables(const recording::merge::MergedLogs& drive, const std::string& out) {
  create_folder(out);
  std::vector<std::string> names;
  std::deque<OutputFile> files;
  for (const std::string_view table : recording::exports::kTableNames) {
    const std::string path = out + "/" + names.emplace_back(std::string(table) + ".csv");
    for (const recording::merge::StoredLog& log : drive.logs()) refuse_overwriting(log.name(), path, "--out");
    files.emplace_back(path);
  }
  TableRows rows = write_tables(
      drive, [&](Table table, std::string_view text) { files[static_cast<std::size_t>(table)].write(text); });
  for (OutputFile& file : files) file.finish();
  for (std::size_t t = 0; t < rows.size(); ++t) rows[t].first = names[t];
  return rows;
}

TableRows export_sqlite(const recording::merge::MergedLogs& drive, const std::string& file) {
  TableDatabase database(file);
  TableRows rows = write_tables(drive, [&](Table table, std::string_view line) { database.write(table, line); });
  database.finish();
  return rows;
}

}  // namespace ttf::cli::exports
