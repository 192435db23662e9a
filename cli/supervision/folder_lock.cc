#include "cli/supervision/folder_lock.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <stdexcept>

#include "core/errors.h"

namespace ttf::cli::supervision {
namespace {

std::string lock_file(const std::string& folder) { return folder + "/launch.lock"; }

// Returns whether the lock is taken. `how` is LOCK_SH for a mere look, which blocks only writers.
bool locked(int file, const std::string& path, int how) {
  int failed = 0;
  do failed = flock(file, how | LOCK_NB);
  while (failed != 0 && errno == EINTR);
  if (failed == 0 || errno == ENOLCK || errno == EOPNOTSUPP) return true;
  if (errno == EWOULDBLOCK) return false;
  throw std::runtime_error(path + ": cannot be locked: " + system_message(errno));
}

std::string number_in(const std::string& path) {
  std::ifstream file(path);
  std::string number;
  file >> number;
  return number.find_first_not_of("0123456789") == std::string::npos ? number : "";
}

[[noreturn]] void refuse(const std::string& folder) {
  const std::string holder = number_in(lock_file(folder));  // empty if the holder has not written it yet
  throw InputError(
      {"command line", 0, "--out", folder,
       fmt::format("must be another folder: a running launch uses it{}", holder.empty() ? "" : ", process " + holder)});
}

}  // namespace

std::optional<FileLock> FileLock::take(const std::string& path) {
  FileLock lock(Descriptor(open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666)));
  if (lock.get() < 0) throw std::runtime_error(path + ": cannot be written: " + system_message(errno));
  return locked(lock.get(), path, LOCK_EX) ? std::optional(std::move(lock)) : std::nullopt;
}

FolderLock::FolderLock(const std::string& folder) : lock_(FileLock::take(lock_file(folder))) {
  if (!lock_) refuse(folder);
  const std::string number = fmt::format("{}\n", getpid());
  if (ftruncate(lock_->get(), 0) != 0 ||
      pwrite(lock_->get(), number.data(), number.size(), 0) != static_cast<ssize_t>(number.size()))
    throw std::runtime_error(lock_file(folder) + ": cannot be written: " + system_message(errno));
}

void FolderLock::refuse_if_held(const std::string& folder) {
  const std::string path = lock_file(folder);
  const Descriptor file(open(path.c_str(), O_RDONLY | O_CLOEXEC));
  if (file.open() && !locked(file.get(), path, LOCK_SH)) refuse(folder);
}

}  // namespace ttf::cli::supervision
