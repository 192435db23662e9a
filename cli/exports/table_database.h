// The tables of a drive in one SQLite file, with the names, columns and values of its CSV files; an empty field is NULL.
#pragma once

#include <deque>
#include <string>
#include <string_view>
#include <vector>

#include "experiments/results/database.h"
#include "recording/exports/tables.h"

namespace ttf::cli::exports {

// The file exists only once it is finished. An older file of its name is gone from the start. All functions throw
// std::runtime_error.
class TableDatabase {
 public:
  explicit TableDatabase(const std::string& path);

  // Takes the lines of TableExport.
  void write(recording::exports::Table table, std::string_view line);
  void finish();

 private:
  // An empty file, which does not stay unless it is finished.
  struct Place {
    explicit Place(const std::string& name);
    ~Place();
    Place(const Place&) = delete;
    Place& operator=(const Place&) = delete;
    std::string path;
    bool finished = false;
  };

  Place place_;
  experiments::results::Database database_;
  struct Rows {
    Rows(const experiments::results::Database& database, recording::exports::Table table);
    std::vector<recording::exports::Column> columns;
    experiments::results::Statement insert;
  };
  std::deque<Rows> rows_;  // by table
};

}  // namespace ttf::cli::exports
