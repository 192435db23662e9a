// Recordings of real sensors that other people made: the repository does not hold them, so a test that wants one is
// skipped where it is not. They lie in the folder that the environment variable TTF_RECORDINGS names; without it, in
// shared/data beside the repository (docs/recordings.md).
#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>

namespace ttf::support {

// Of a file by its path in that folder, whether it is there or not.
inline std::string recording_path(const std::string& name) {
  const char* folder = std::getenv("TTF_RECORDINGS");
  const std::filesystem::path beside = std::filesystem::path(TTF_SOURCE_DIR).parent_path() / "shared" / "data";
  return ((folder != nullptr && *folder != '\0' ? std::filesystem::path(folder) : beside) / name).string();
}

// Why a test is skipped, and what would change that.
inline std::string recording_missing(const std::string& name) {
  return "there is no recording " + recording_path(name) + "; set TTF_RECORDINGS to the folder that holds " + name;
}

}  // namespace ttf::support
