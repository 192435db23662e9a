// One SQLite file, and statements on it.
//
// While a process writes, its changes go into SQLite's WAL, FILE-wal with its index FILE-shm. Readers then do not wait
// for the writer, nor the writer for them. The end of writing takes the changes into the file. If another process
// still reads at that moment, or if the writer is killed, they stay in the WAL; the next process that opens the file
// finds them. The index is shared memory, which several machines do not share. So on a file system that may belong
// to several machines there is no WAL, and a writer waits for readers.
//
// A process that finds the file locked waits, a minute at most.
#pragma once

#include <sqlite3.h>

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

#include "experiments/results/locked.h"

namespace ttf::experiments::results {

class Database {
 public:
  enum class Begin : std::uint8_t { kAsItIs, kAnew };
  // Throws std::runtime_error, also for a file that is no database.
  Database(const std::string& file, Begin begin);
  ~Database();
  Database(const Database&) = delete;
  Database& operator=(const Database&) = delete;

  void wait_by(Waiting waiting) { waiting_ = std::move(waiting); }
  // Comes before every change. Throws Locked.
  void begin_writing();
  // Throws Locked or std::runtime_error.
  void execute(const std::string& sql) const;
  // Ends a transaction without its changes; some errors have done so already.
  void roll_back() const noexcept;
  [[noreturn]] void fail() const;
  sqlite3* handle() const { return handle_; }

  // Removes the files that a killed writer left beside a file that is gone: they would change a new one.
  static void remove_beside(const std::string& file);

 private:
  int open(const std::string& name, int flags);
  bool wait(int calls);

  sqlite3* handle_ = nullptr;
  std::string path_;
  Waiting waiting_;
  bool writes_ = false;
};

// Its database must outlive it. All functions throw as Database::execute() does.
class Statement {
 public:
  Statement(const Database& database, const std::string& sql);
  ~Statement() { sqlite3_finalize(handle_); }
  Statement(const Statement&) = delete;
  Statement& operator=(const Statement&) = delete;

  void bind(int at, std::int64_t value);
  void bind(int at, double value);  // NULL if it is NaN
  void bind(int at, std::string_view text);
  bool row();  // false: no more rows
  void again() { sqlite3_reset(handle_); }
  std::int64_t integer(int column) const { return sqlite3_column_int64(handle_, column); }
  double number(int column) const;  // NaN if it is NULL
  std::string text(int column) const;

 private:
  void check(int code) const {
    if (code != SQLITE_OK) database_.fail();
  }

  const Database& database_;
  sqlite3_stmt* handle_ = nullptr;
};

}  // namespace ttf::experiments::results
