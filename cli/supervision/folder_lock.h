// A folder is of one launch at a time: what another one would remove and write there is its own.
//
// Held by a lock of the kernel's (flock) on launch.lock in the folder, which holds the number of the process. It goes
// with the process, however that ends: a file that is left means nothing. None of what the launch starts inherits it.
#pragma once

#include <optional>
#include <string>
#include <utility>

#include "cli/supervision/descriptor.h"

namespace ttf::cli::supervision {

// Whose file it is: the kernel's lock on a file that is made where it is not there, and left as it is.
class FileLock {
 public:
  // Nothing: somebody else has it. Throws std::runtime_error where it cannot be opened for writing, or cannot be
  // locked; on a file system that has no locks everybody has it.
  static std::optional<FileLock> take(const std::string& path);
  int get() const { return file_.get(); }

 private:
  explicit FileLock(Descriptor file) : file_(std::move(file)) {}
  Descriptor file_;
};

class FolderLock {
 public:
  // Of a folder that is there. Throws InputError that names folder and process where another launch has it,
  // std::runtime_error where the file cannot be written.
  explicit FolderLock(const std::string& folder);

  // Throws the same InputError where a launch has it; leaves nothing. A folder that is not there is nobody's.
  static void refuse_if_held(const std::string& folder);

 private:
  std::optional<FileLock> lock_;
};

}  // namespace ttf::cli::supervision
