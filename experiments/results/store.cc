#include "experiments/results/store.h"

#include <charconv>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "core/errors.h"
#include "experiments/results/database.h"

namespace ttf::experiments::results {
namespace {

constexpr const char* kReplications = "replications";  // a key of meta

// Quotes a name from an experiment file, so that it stays a name whatever it is.
std::string identifier(std::string_view name) {
  std::string out = "\"";
  for (const char c : name) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + '"';
}

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
  create_in(Database(unfinished, Database::Begin::kAnew), head);
  Database::remove_beside(path);
  std::filesystem::rename(unfinished, path);
  return open(path);
}

void Store::create_in(const Database& database, const StoreHead& head) {
  database.execute("BEGIN; CREATE TABLE meta(key TEXT PRIMARY KEY, value TEXT NOT NULL) WITHOUT ROWID");
  Statement meta(database, "INSERT INTO meta VALUES(?, ?)");
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
    Store store(std::make_unique<Database>(path, Database::Begin::kAsItIs));
    Statement meta(*store.database_, "SELECT key, value FROM meta");
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
    // Checks that the columns are as stated.
    Statement rows(*store.database_, "SELECT " + columns(store.head_) + " FROM runs LIMIT 1");
    (void)rows.row();
    return store;
  } catch (const Locked&) {
    throw;
  } catch (const std::runtime_error& error) {
    throw InputError({path, 0, "", "", std::string("must be a store of runs; SQLite says: ") + error.what()});
  }
}

void Store::wait_by(Waiting waiting) { database_->wait_by(std::move(waiting)); }

void Store::ask_for(std::uint32_t replications) {
  database_->begin_writing();
  Statement meta(*database_, "INSERT OR REPLACE INTO meta VALUES(?, ?)");
  const std::string value = std::to_string(replications);
  meta.bind(1, std::string_view(kReplications));
  meta.bind(2, std::string_view(value));
  meta.row();
  head_.replications = replications;
}

void Store::add(const std::vector<Row>& rows) {
  std::string marks = "?, ?, ?, ?";
  for (std::size_t m = 0; m < head_.measures.size(); ++m) marks += ", ?";
  database_->begin_writing();
  database_->execute("BEGIN");
  try {
    Statement insert(*database_, "INSERT OR IGNORE INTO runs(" + columns(head_) + ") VALUES(" + marks + ")");
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
    database_->roll_back();
    throw;
  }
}

std::uint64_t Store::count() const {
  Statement count(*database_, "SELECT count(*) FROM runs");
  count.row();
  return static_cast<std::uint64_t>(count.integer(0));
}

std::vector<RowKey> Store::keys() const {
  std::vector<RowKey> keys;
  Statement rows(*database_,
                 "SELECT point, replication, paradigm, status FROM runs ORDER BY point, replication, paradigm");
  while (rows.row()) keys.push_back(row_of(rows, 0).key);
  return keys;
}

void Store::for_each(const std::function<void(const ttf::experiments::results::Row&)>& use) const {
  Statement rows(*database_, "SELECT " + columns(head_) + " FROM runs ORDER BY point, replication, paradigm");
  while (rows.row()) use(row_of(rows, head_.measures.size()));
}

std::vector<Row> Store::of_point(std::uint32_t point) const {
  std::vector<Row> found;
  Statement rows(*database_, "SELECT " + columns(head_) + " FROM runs WHERE point = ? ORDER BY replication, paradigm");
  rows.bind(1, std::int64_t{point});
  while (rows.row()) found.push_back(row_of(rows, head_.measures.size()));
  return found;
}

}  // namespace ttf::experiments::results
