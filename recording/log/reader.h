// Reads a log back: passes every record to a sink, in the order of writing.
//
// Lengths and counts in the file are never trusted. Damaged parts are left out and named in `warning`:
//   a torn tail (crash while writing)    everything before the cut is read, `truncated` is set
//   a damaged chunk                      that chunk is left out
//   damage between chunks                reading goes on at the next chunk
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "recording/log/content_hash.h"
#include "recording/log/manifest.h"
#include "recording/records/kinds.h"
#include "recording/records/records.h"

namespace ttf::recording::log {

struct Attachment {
  std::string name, media_type, bytes;
  bool operator==(const Attachment&) const = default;
};

struct LogInfo {
  LogManifest manifest;
  bool manifest_sound = false;                              // else it is missing, or may be wrong
  std::vector<Attachment> attachments;                      // in file order
  bool truncated = false;                                   // false: missing, or perhaps wrong
  std::string warning;                                      // sentences, empty for a sound file
  std::array<std::uint64_t, records::kKindCount> counts{};  // records read, by the number of their kind - 1
  std::uint64_t chunks_read = 0;
  std::uint64_t chunks_lost = 0;                     // damaged ones that were recognised as chunks
  std::uint64_t content_hash = 0;                    // over the records read
  ContentHash records;                               // the same, for adding up over several logs
  std::optional<std::uint64_t> stated_content_hash;  // as the writer stated it at the end; absent in a torn file

  std::uint64_t count(records::RecordKind kind) const { return counts[records::number_of(kind) - 1]; }
};

// Throws InputError if the file cannot be read, is not MCAP, is an MCAP file of another program, or ends before
// its manifest. Spans handed to the sink are valid during the call only.
LogInfo read_log(const std::string& path, records::Sink& sink);

// Reads a log from bytes in memory; errors and warnings call it `name`. `on_chunk` receives the content of
// every sound chunk, as a part of `bytes`, before the sink receives its records.
using ChunkListener = std::function<void(std::string_view content)>;
LogInfo read_log_bytes(std::string_view bytes, const std::string& name, records::Sink& sink,
                       const ChunkListener& on_chunk = {});

}  // namespace ttf::recording::log
