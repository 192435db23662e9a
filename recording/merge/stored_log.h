// A log in memory, as its file's bytes, read through once for its manifest and the times of its chunks. Damaged
// parts are left out and have a warning; the listed chunks are sound.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/time.h"
#include "recording/log/reader.h"
#include "recording/merge/common_time.h"

namespace ttf::recording::merge {

// Returns the logs (*.mcap) of a folder, by name; empty if the folder is unreadable.
std::vector<std::string> logs_in(const std::string& folder);

class StoredLog {
 public:
  // Throws InputError as read_log() does.
  explicit StoredLog(const std::string& path);
  StoredLog(std::string bytes, std::string name);
  StoredLog(StoredLog&&) = default;
  StoredLog& operator=(StoredLog&&) = default;

  const std::string& name() const { return name_; }
  const log::LogInfo& info() const { return info_; }

  // A chunk, with the first and last true time of its records.
  struct Chunk {
    std::size_t begin = 0, size = 0;  // its record's content, within the bytes
    TrueTime first{}, last{};
  };
  const std::vector<Chunk>& chunks() const { return chunks_; }  // in file order, each with a readable record
  // Relates the global times of its nodes to its true time, if that is a machine's clock.
  const std::vector<SyncStamp>& sync_stamps() const { return sync_stamps_; }
  std::string_view content(const Chunk& chunk) const {
    return std::string_view(bytes_).substr(chunk.begin, chunk.size);
  }

 private:
  std::string name_;
  std::string bytes_;
  log::LogInfo info_;
  std::vector<Chunk> chunks_;
  std::vector<SyncStamp> sync_stamps_;
};

}  // namespace ttf::recording::merge
