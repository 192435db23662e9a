// A log in memory, as its file's bytes, read through once: what it says of itself, and which of its chunks has records
// of which time. What is damaged is left out here and has its warning; the chunks listed are sound.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/time.h"
#include "recording/log/reader.h"
#include "recording/merge/common_time.h"

namespace ttf::recording::merge {

// The logs (*.mcap) of a folder, by their names; none where it cannot be read.
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

  // From the first to the last of its records' true times.
  struct Chunk {
    std::size_t begin = 0, size = 0;  // of its record's content, in the bytes
    TrueTime first{}, last{};
  };
  const std::vector<Chunk>& chunks() const { return chunks_; }  // in file order; none without a readable record
  // How its nodes' global times relate to its true time, where that is a host's clock.
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
