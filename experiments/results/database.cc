#include "experiments/results/database.h"

#include <fmt/format.h>
#include <linux/magic.h>
#include <sys/vfs.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <limits>
#include <system_error>
#include <thread>

namespace ttf::experiments::results {
namespace {

constexpr std::chrono::milliseconds kTurn{50};  // between two tries
constexpr int kTries = 1200;                    // a minute

constexpr const char* kWal = "-wal";
constexpr const char* kBeside[] = {kWal, "-shm", "-journal"};

// File systems of one machine, by their numbers in statfs(2); ZFS has no name in magic.h.
constexpr std::int64_t kZfs = 0x2FC12FC1;
constexpr std::int64_t kOfOneMachine[] = {EXT4_SUPER_MAGIC, XFS_SUPER_MAGIC, BTRFS_SUPER_MAGIC,     F2FS_SUPER_MAGIC,
                                          TMPFS_MAGIC,      RAMFS_MAGIC,     OVERLAYFS_SUPER_MAGIC, kZfs};

bool is_of_one_machine(const std::string& file) {
  struct statfs found {};
  return ::statfs(file.c_str(), &found) == 0 && std::find(std::begin(kOfOneMachine), std::end(kOfOneMachine),
                                                          std::int64_t{found.f_type}) != std::end(kOfOneMachine);
}

bool has_content(const std::string& file) {
  std::error_code none;
  const auto size = std::filesystem::file_size(file, none);
  return !none && size > 0;
}

// Returns the file as an address, with SQLite's promise that nothing changes it.
std::string unchanging(const std::string& file) {
  std::string address = "file://";
  for (const char c : std::filesystem::absolute(file).lexically_normal().string())
    address +=
        c == '%' || c == '?' || c == '#' ? fmt::format("%{:02X}", static_cast<unsigned char>(c)) : std::string(1, c);
  return address + "?immutable=1";
}

}  // namespace

Database::Database(const std::string& file, Begin begin) : path_(file) {
  constexpr const char* kLook = "SELECT 1 FROM sqlite_master LIMIT 1";
  const int create = begin == Begin::kAnew ? SQLITE_OPEN_CREATE : 0;
  int code = open(file, SQLITE_OPEN_READWRITE | create);
  if (code == SQLITE_OK) code = sqlite3_exec(handle_, kLook, nullptr, nullptr, nullptr);
  // The last writer left the file for use with a WAL, which cannot be made in this folder. The file has all changes.
  const bool needs_wal = create == 0 && (code == SQLITE_CANTOPEN || code == SQLITE_READONLY);
  if (needs_wal && !has_content(file + kWal)) {
    code = open(unchanging(file), SQLITE_OPEN_READONLY | SQLITE_OPEN_URI);
    if (code == SQLITE_OK) code = sqlite3_exec(handle_, kLook, nullptr, nullptr, nullptr);
  }
  if (code == SQLITE_OK) return;
  try {
    if (needs_wal && has_content(file + kWal))
      throw std::runtime_error(file + ": has changes in " + kWal +
                               " beside it, to be read in a folder that can be written");
    fail();
  } catch (...) {
    sqlite3_close(handle_);
    throw;
  }
}

Database::~Database() {
  // Without success, the WAL stays.
  if (writes_) sqlite3_exec(handle_, "PRAGMA journal_mode = DELETE", nullptr, nullptr, nullptr);
  sqlite3_close(handle_);
}

int Database::open(const std::string& name, int flags) {
  sqlite3_close(handle_);
  const int code = sqlite3_open_v2(name.c_str(), &handle_, flags, nullptr);
  if (handle_ != nullptr)
    sqlite3_busy_handler(
        handle_, [](void* self, int calls) { return static_cast<Database*>(self)->wait(calls) ? 1 : 0; }, this);
  return code;
}

bool Database::wait(int calls) {
  if (waiting_) return waiting_(calls);
  if (calls >= kTries) return false;
  std::this_thread::sleep_for(kTurn);
  return true;
}

void Database::begin_writing() {
  if (writes_) return;
  writes_ = true;
  if (!is_of_one_machine(path_)) return;
  // Any other failure is the next change's, too; or there is no WAL.
  if (sqlite3_exec(handle_, "PRAGMA journal_mode = WAL", nullptr, nullptr, nullptr) == SQLITE_BUSY) {
    writes_ = false;
    fail();
  }
}

void Database::execute(const std::string& sql) const {
  if (sqlite3_exec(handle_, sql.c_str(), nullptr, nullptr, nullptr) != SQLITE_OK) fail();
}

void Database::roll_back() const noexcept { sqlite3_exec(handle_, "ROLLBACK", nullptr, nullptr, nullptr); }

void Database::fail() const {
  if (handle_ == nullptr) throw std::runtime_error(path_ + ": no memory");
  const int code = sqlite3_errcode(handle_);
  if (code == SQLITE_BUSY || code == SQLITE_LOCKED)
    throw Locked(path_ + ": is locked by another process, and waiting for it did not help");
  throw std::runtime_error(path_ + ": " + sqlite3_errmsg(handle_));
}

void Database::remove_beside(const std::string& file) {
  std::error_code none;
  for (const char* const ending : kBeside) std::filesystem::remove(file + ending, none);
}

Statement::Statement(const Database& database, const std::string& sql) : database_(database) {
  check(sqlite3_prepare_v2(database.handle(), sql.c_str(), -1, &handle_, nullptr));
}

void Statement::bind(int at, std::int64_t value) { check(sqlite3_bind_int64(handle_, at, value)); }

void Statement::bind(int at, double value) {
  check(std::isnan(value) ? sqlite3_bind_null(handle_, at) : sqlite3_bind_double(handle_, at, value));
}

void Statement::bind(int at, std::string_view text) {
  check(sqlite3_bind_text(handle_, at, text.data(), static_cast<int>(text.size()), SQLITE_TRANSIENT));
}

bool Statement::row() {
  const int code = sqlite3_step(handle_);
  if (code != SQLITE_ROW && code != SQLITE_DONE) database_.fail();
  return code == SQLITE_ROW;
}

double Statement::number(int column) const {
  return sqlite3_column_type(handle_, column) == SQLITE_NULL ? std::numeric_limits<double>::quiet_NaN()
                                                             : sqlite3_column_double(handle_, column);
}

std::string Statement::text(int column) const {
  const unsigned char* text = sqlite3_column_text(handle_, column);
  return text == nullptr ? std::string() : std::string(reinterpret_cast<const char*>(text));
}

}  // namespace ttf::experiments::results
