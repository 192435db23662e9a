// A folder belongs to one launch at a time, because a launch removes and writes files there.
//
// The kernel's lock (flock) on launch.lock in the folder marks the owner; the file holds its process number. The lock
// ends with the process in any case, so a left file has no meaning. Started processes do not inherit the lock.
#pragma once

#include <optional>
#include <string>
#include <utility>

#include "cli/supervision/descriptor.h"

namespace ttf::cli::supervision {

// The kernel's lock on a file, which is created if missing and otherwise left unchanged.
class FileLock {
 public:
  // Returns no value if another process holds the lock. Throws std::runtime_error if the file cannot be
  // opened for writing or locked. On a file system without locks every process gets it.
  static std::optional<FileLock> take(const std::string& path);
  int get() const { return file_.get(); }

 private:
  explicit FileLock(Descriptor file) : file_(std::move(file)) {}
  Descriptor file_;
};

class FolderLock {
 public:
  // Locks an existing folder. Throws InputError with folder and process if another launch holds it,
  // std::runtime_error if the file cannot be written.
  explicit FolderLock(const std::string& folder);

  // Throws the same InputError if a launch holds the folder; leaves no trace. A missing folder is free.
  static void refuse_if_held(const std::string& folder);

 private:
  std::optional<FileLock> lock_;
};

}  // namespace ttf::cli::supervision
