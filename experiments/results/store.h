// Keeps the results of drives in one SQLite file, a row per drive, as soon as it is done. A killed process
// loses only uncommitted rows. Others may read the file at any time: while it is written, two more files lie beside
// it (experiments/results/database.h), and a finished store is one file.
//
//   meta(key, value)                           the drives' origin: name, identity, version, the experiment's text;
//                                              the number of replications wanted of every point
//   runs(point, replication, paradigm,         the drive's key
//        status,                               "done", or a sentence about the failure
//        <a column a measure>)                 real; NULL if the drive has none
//
// Rows come back in the order of their keys.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "experiments/results/locked.h"

namespace ttf::experiments::results {

class Database;

struct RowKey {
  std::uint32_t point = 0, replication = 0, paradigm = 0;
  auto operator<=>(const RowKey&) const = default;
};

struct Row {
  RowKey key;
  std::string status;          // kDone, or the failure
  std::vector<double> values;  // by measure; NaN if the drive has none
};
inline constexpr const char* kDone = "done";

struct StoreHead {
  std::string name;
  // Hashes of all files behind the drives, and of the program: stores with both equal hold the same drives.
  std::string identity, version;
  std::string text;  // the experiment's file
  std::vector<std::string> measures;
  std::uint32_t replications = 0;  // wanted of every point; 0: not stated
};

class Store {
 public:
  // Creates a store. Throws std::runtime_error if the file exists already or cannot be written.
  static Store create(const std::string& path, const StoreHead& head);
  // Opens a store for reading and writing; only a change changes the file. Throws InputError if the file is no
  // store, and Locked as all functions do.
  static Store open(const std::string& path);
  ~Store();
  Store(Store&&) noexcept;
  Store& operator=(Store&&) noexcept;

  const StoreHead& head() const { return head_; }
  // Replaces the wait for a file that another process has locked, by default a minute.
  void wait_by(Waiting waiting);
  // Sets the number wanted from now on. Throws std::runtime_error.
  void ask_for(std::uint32_t replications);
  // Adds all of them, or none; a row that exists stays as it is. Throws std::runtime_error, for instance if the
  // disk is full; earlier rows remain.
  void add(const std::vector<Row>& rows);
  std::uint64_t count() const;
  std::vector<RowKey> keys() const;                                                            // in order
  void for_each(const std::function<void(const ttf::experiments::results::Row&)>& use) const;  // in order
  std::vector<Row> of_point(std::uint32_t point) const;                                        // in order

 private:
  explicit Store(std::unique_ptr<Database> database);
  static void create_in(const Database& database, const StoreHead& head);
  std::unique_ptr<Database> database_;
  StoreHead head_;
};

}  // namespace ttf::experiments::results
