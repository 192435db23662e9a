#include "experiments/results/store.h"

#include <fmt/format.h>
#include <sqlite3.h>

#include <charconv>
#include <cmath>
#include <filesystem>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string_view>

#include "core/errors.h"

namespace ttf::experiments::results {
namespace {

constexpr const char* kReplications = "replications";  // a key of meta

// Quotes a name from an experiment file, so that it stays a name whatever it is.
std::string identifier(std::string_view name) {
  std::string out = "\"";
  for (const char c : name) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + '"';
}

std::string reason(sqlite3* handle) {
  const int code = sqlite3_errcode(handle);
  return code == SQLITE_BUSY || code == SQLITE_LOCKED ? "is in use: another process writes there"
                                                      : sqlite3_errmsg(handle);
}

}  // namespace

struct Store::Database {
  sqlite3* handle = nullptr;
  std::string path;

  Database(const std::string& file, int flags) : path(file) {
    if (sqlite3_open_v2(file.c_str(), &handle, flags, nullptr) == SQLITE_OK) return;
    const std::string why = handle != nullptr ? sqlite3_errmsg(handle) : "no memory";
    sqlite3_close(handle);
    throw std::runtime_error(file + ": " + why);
  }
  ~Database() { sqlite3_close(handle); }
  Database(const Database&) = delete;
  Database& operator=(const Database&) = delete;

  [[noreturn]] void fail() const { throw std::runtime_error(path + ": " + reason(handle)); }
  void execute(const std::string& sql) const {
    if (sqlite3_exec(handle, sql.c_str(), nullptr, nullptr, nullptr) != SQLITE_OK) fail();
  }
};

namespace {

class Statement {
 public:
  Statement(sqlite3* database, const std::string& path, const std::string& sql) : database_(database), path_(path) {
    if (sqlite3_prepare_v2(database, sql.c_str(), -1, &handle_, nullptr) != SQLITE_OK) fail();
  }
  ~Statement() { sqlite3_finalize(handle_); }
  Statement(const Statement&) = delete;
  Statement& operator=(const Statement&) = delete;

  void bind(int at, std::int64_t value) { check(sqlite3_bind_int64(handle_, at, value)); }
  void bind(int at, double value) {
    check(std::isnan(value) ? sqlite3_bind_null(handle_, at) : sqlite3_bind_double(handle_, at, value));
  }
  void bind(int at, std::string_view text) {
    check(sqlite3_bind_text(handle_, at, text.data(), static_cast<int>(text.size()), SQLITE_TRANSIENT));
  }
  bool row() {  // false: no more rows
    const int code = sqlite3_step(handle_);
    if (code != SQLITE_ROW && code != SQLITE_DONE) fail();
    return code == SQLITE_ROW;
  }
  void again() { sqlite3_reset(handle_); }
  std::int64_t integer(int column) const { return sqlite3_column_int64(handle_, column); }
  double number(int column) const {
    return sqlite3_column_type(handle_, column) == SQLITE_NULL ? std::numeric_limits<double>::quiet_NaN()
                                                               : sqlite3_column_double(handle_, column);
  }
  std::string text(int column) const {
    const unsigned char* text = sqlite3_column_text(handle_, column);
    return text == nullptr ? std::string() : std::string(reinterpret_cast<const char*>(text));
  }

 private:
  void check(int code) const {
    if (code != SQLITE_OK) fail();
  }
  [[noreturn]] void fail() const { throw std::runtime_error(path_ + ": " + reason(database_)); }

  sqlite3* database_;
  const std::string& path_;
  sqlite3_stmt* handle_ = nullptr;
};

Row row_of(const Statement& statement, std::size_t measures) {
  Row row;
  row.key = {static_cast<std::uint32_t>(statement.integer(0)), static_cast<std::uint32_t>(statement.integer(1)),
             static_cast<std::uint32_t>(statement.integer(2))};
  row.status = statement.text(3);
  for (std::size_t m = 0; m < measures; ++m) row.values.push_back(statement.number(4 + static_cast<int>(m)));
  return row;
}

std::string columns(const StoreHead& head) {
  std::string list = "point, replication, paradigm, status";
  for (const std::string& measure : head.measures) list += ", " + identifier(measure);
  return list;
}

}  // namespace

Store::Store(std::unique_ptr<Database> database) : database_(std::move(database)) {}
Store::~Store() = default;
Store::Store(Store&&) noexcept = default;
Store& Store::operator=(Store&&) noexcept = default;

Store Store::create(const std::string& path, const StoreHead& head) {
  if (std::filesystem::exists(path)) throw std::runtime_error(path + ": exists already");
  // Under another name until it is whole: a store needs its head.
  const std::string unfinished = path + ".new";
  std::filesystem::remove(unfinished);
  create_in(Database(unfinished, SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE), head);
  std::filesystem::rename(unfinished, path);
  return open(path);
}

void Store::create_in(const Database& database, const StoreHead& head) {
  database.execute("BEGIN; CREATE TABLE meta(key TEXT PRIMARY KEY, value TEXT NOT NULL) WITHOUT ROWID");
  Statement meta(database.handle, database.path, "INSERT INTO meta VALUES(?, ?)");
  std::string measures, table;
  for (const std::string& measure : head.measures) {
    measures += measure + '\n';
    table += ", " + identifier(measure) + " REAL";
  }
  using Pair = std::pair<std::string_view, std::string_view>;
  const std::string replications = std::to_string(head.replications);
  for (const auto& [key, value] :
       {Pair{"name", head.name}, Pair{"identity", head.identity}, Pair{"version", head.version},
        Pair{"text", head.text}, Pair{"measures", measures}, Pair{kReplications, replications}}) {
    meta.bind(1, key);
    meta.bind(2, value);
    meta.row();
    meta.again();
  }
  database.execute("CREATE TABLE runs(point INTEGER, replication INTEGER, paradigm INTEGER, status TEXT NOT NULL" +
                   table + ", PRIMARY KEY(point, replication, paradigm)) WITHOUT ROWID; COMMIT");
}

Store Store::open(const std::string& path) {
  if (!std::filesystem::exists(path)) throw InputError({path, 0, "", "", "cannot be opened: no such file"});
  try {
    Store store(std::make_unique<Database>(path, SQLITE_OPEN_READWRITE));
    Statement meta(store.database_->handle, store.database_->path, "SELECT key, value FROM meta");
    std::optional<std::string> measures;
    while (meta.row()) {
      const std::string key = meta.text(0), value = meta.text(1);
      if (key == "name") store.head_.name = value;
      if (key == "identity") store.head_.identity = value;
      if (key == "version") store.head_.version = value;
      if (key == "text") store.head_.text = value;
      if (key == "measures") measures = value;
      if (key == kReplications &&
          std::from_chars(value.data(), value.data() + value.size(), store.head_.replications).ec != std::errc{})
        throw std::runtime_error(path + ": replications must be a number");
    }
    if (!measures) throw std::runtime_error(path + ": no measures");
    for (std::size_t begin = 0, end = 0; (end = measures->find('\n', begin)) != std::string::npos; begin = end + 1)
      store.head_.measures.push_back(measures->substr(begin, end - begin));
    Statement rows(store.database_->handle, store.database_->path,
                   "SELECT " + columns(store.head_) + " FROM runs LIMIT 1");  // whether the columns are as stated
    (void)rows.row();
    return store;
  } catch (const std::runtime_error& error) {
    throw InputError({path, 0, "", "", std::string("must be a store of runs; SQLite says: ") + error.what()});
  }
}

void Store::ask_for(std::uint32_t replications) {
  Statement meta(database_->handle, database_->path, "INSERT OR REPLACE INTO meta VALUES(?, ?)");
  const std::string value = std::to_string(replications);
  meta.bind(1, std::string_view(kReplications));
  meta.bind(2, std::string_view(value));
  meta.row();
  head_.replications = replications;
}

void Store::add(const std::vector<Row>& rows) {
  std::string marks = "?, ?, ?, ?";
  for (std::size_t m = 0; m < head_.measures.size(); ++m) marks += ", ?";
  database_->execute("BEGIN");
  try {
    Statement insert(database_->handle, database_->path,
                     "INSERT OR IGNORE INTO runs(" + columns(head_) + ") VALUES(" + marks + ")");
    for (const Row& row : rows) {
      insert.bind(1, std::int64_t{row.key.point});
      insert.bind(2, std::int64_t{row.key.replication});
      insert.bind(3, std::int64_t{row.key.paradigm});
      insert.bind(4, std::string_view(row.status));
      for (std::size_t m = 0; m < head_.measures.size(); ++m) insert.bind(5 + static_cast<int>(m), row.values.at(m));
      insert.row();
      insert.again();
    }
    database_->execute("COMMIT");
  } catch (...) {
    sqlite3_exec(database_->handle, "ROLLBACK", nullptr, nullptr, nullptr);  // some errors have rolled back already
    throw;
  }
}

std::uint64_t Store::count() const {
  Statement count(database_->handle, database_->path, "SELECT count(*) FROM runs");
  count.row();
  return static_cast<std::uint64_t>(count.integer(0));
}

std::vector<RowKey> Store::keys() const {
  std::vector<RowKey> keys;
  Statement rows(database_->handle, database_->path,
                 "SELECT point, replication, paradigm, status FROM runs ORDER BY point, replication, paradigm");
  while (rows.row()) keys.push_back(row_of(rows, 0).key);
  return keys;
}

void Store::for_each(const std::function<void(const ttf::experiments::results::Row&)>& use) const {
  Statement rows(database_->handle, database_->path,
                 "SELECT " + columns(head_) + " FROM runs ORDER BY point, replication, paradigm");
  while (rows.row()) use(row_of(rows, head_.measures.size()));
}

std::vector<Row> Store::of_point(std::uint32_t point) const {
  std::vector<Row> found;
  Statement rows(database_->handle, database_->path,
                 "SELECT " + columns(head_) + " FROM runs WHERE point = ? ORDER BY replication, paradigm");
  rows.bind(1, std::int64_t{point});
  while (rows.row()) found.push_back(row_of(rows, head_.measures.size()));
  return found;
}

}  // namespace ttf::experiments::results
