// Reads a log back: drives a sink with every record, in the order they were written.
//
// Lengths and counts in the file are never trusted. What is damaged is left out and named in `warning`:
//   a torn tail (crash while writing)    everything before the cut is read, `truncated` is set
//   a damaged chunk                      that chunk is left out
//   damage between chunks                reading goes on at the next chunk
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "recording/log_manifest.h"
#include "recording/records/records.h"

namespace ttf::recording {

struct LogInfo {
  LogManifest manifest;
  std::vector<std::pair<std::string, std::string>> attachments;  // name, bytes; in file order
  bool truncated = false;                                        // the file ends before its closing record
  std::string warning;                                           // sentences, empty for a sound file
  std::array<std::uint64_t, kRecordKinds> counts{};              // records read, by RecordKind - 1
  std::uint64_t chunks_read = 0;
  std::uint64_t chunks_lost = 0;   // damaged ones that were recognised as chunks
  std::uint64_t content_hash = 0;  // over the records read
  std::optional<std::uint64_t>
      stated_content_hash;  // as the writer wrote it at the end; absent in a torn file

  std::uint64_t count(RecordKind kind) const { return counts[static_cast<std::size_t>(kind) - 1]; }
};

// Throws InputError if the file cannot be read, is not MCAP, is MCAP but no log of this program, or is cut off before its
// manifest. Spans
// handed to the sink are valid during the call only.
LogInfo read_log(const std::string& path, records::Sink& sink);

// The same on bytes in memory; `name` is what errors and warnings call it.
LogInfo read_log_bytes(std::string_view bytes, const std::string& name, records::Sink& sink);

}  // namespace ttf::recording
