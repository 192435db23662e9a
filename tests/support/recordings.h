// Third parties' recordings of real sensors. The repository does not contain them, so tests skip when they
// are absent. They are in the folder that the environment variable TTF_RECORDINGS names; without it, in
// shared/data beside the repository (docs/use/recordings.md).
#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>

namespace ttf::support {

// Returns a file's path in that folder, existing or not.
inline std::string recording_path(const std::string& name) {
  const char* folder = std::getenv("TTF_RECORDINGS");
  const std::filesystem::path beside = std::filesystem::path(TTF_SOURCE_DIR).parent_path() / "shared" / "data";
  return ((folder != nullptr && *folder != '\0' ? std::filesystem::path(folder) : beside) / name).string();
}

// The reason for skipping a test, and its remedy.
inline std::string recording_missing(const std::string& name) {
  return "there is no recording " + recording_path(name) + "; set TTF_RECORDINGS to the folder that holds " + name;
}

}  // namespace ttf::support
