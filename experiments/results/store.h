// What runs came to, in one SQLite file: a row a run, as soon as it is there. Whoever is killed has lost what was not
// committed and nothing else.
//
//   meta(key, value)                           what the runs are of: name, identity, version, the experiment's text;
//                                              replications, how many of every point are asked for
//   runs(point, replication, paradigm,         the run's key
//        status,                               "done", or in a sentence what went wrong
//        <a column a measure>)                 real; NULL where a run has none
//
// Rows come back in the order of their keys, whatever order they came in.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace ttf::experiments::results {

struct RunKey {
  std::uint32_t point = 0, replication = 0, paradigm = 0;
  auto operator<=>(const RunKey&) const = default;
};

struct Run {
  RunKey key;
  std::string status;          // kDone, or what went wrong
  std::vector<double> values;  // by measure; NaN where there is none
};
inline constexpr const char* kDone = "done";

struct StoreHead {
  std::string name;
  // Of all files the runs follow from, and of the program: two stores of the same of both hold the same runs.
  std::string identity, version;
  std::string text;  // the experiment's file
  std::vector<std::string> measures;
  std::uint32_t replications = 0;  // asked for, of every point; none: nobody said
};

class Store {
 public:
  // Creates it. Throws std::runtime_error where the file is there already or cannot be written.
  static Store create(const std::string& path, const StoreHead& head);
  // Opens one, for reading too. Throws InputError where it is none.
  static Store open(const std::string& path);
  ~Store();
  Store(Store&&) noexcept;
  Store& operator=(Store&&) noexcept;

  const StoreHead& head() const { return head_; }
  // From now on so many are asked for. Throws std::runtime_error.
  void ask_for(std::uint32_t replications);
  // All or none of them; a run that is there already stays as it is. Throws std::runtime_error, disk full for instance:
  // what was there before still is.
  void add(const std::vector<Run>& runs);
  std::uint64_t count() const;
  std::vector<RunKey> keys() const;                                                            // in order
  void for_each(const std::function<void(const ttf::experiments::results::Run&)>& use) const;  // in order
  std::vector<Run> of_point(std::uint32_t point) const;                                        // in order

 private:
  struct Database;
  explicit Store(std::unique_ptr<Database> database);
  static void create_in(const Database& database, const StoreHead& head);
  std::unique_ptr<Database> database_;
  StoreHead head_;
};

}  // namespace ttf::experiments::results
