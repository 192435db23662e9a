// A writer of MCAP files (https://mcap.dev/spec, version 0): zstd chunks, message indexes, attachments,
// metadata, summary with statistics and offsets, all checksums.
//
// A chunk closes when it holds kChunkBytes, or when the next message would make it span more than kChunkSpan of
// log time. It never closes by the machine's clock: the same messages give the same bytes. A closed chunk and
// its indexes are flushed at once, so a crash loses only the open chunk. After construction, only
// close() throws: the first write error.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace ttf::recording::mcap {

class McapWriter {
 public:
  static constexpr std::size_t kChunkBytes = 256 * 1024;
  static constexpr std::uint64_t kChunkSpan = 250'000'000;  // ns of log time

  using Entries = std::vector<std::pair<std::string, std::string>>;

  // Throws std::runtime_error if `path` cannot be created. `profile` and `library` go into the header record.
  McapWriter(const std::string& path, std::string_view profile, std::string_view library);
  ~McapWriter();  // abandons the open chunk and the summary: the file reads as torn
  McapWriter(const McapWriter&) = delete;
  McapWriter& operator=(const McapWriter&) = delete;

  // Schemas and channels are declared before the first message and outside chunks. Their ids ascend from 1. They may
  // leave gaps, for which a channel costs memory.
  void add_schema(std::uint16_t id, std::string_view name, std::string_view encoding, std::string_view data);
  void add_channel(std::uint16_t id, std::uint16_t schema, std::string_view topic, std::string_view encoding,
                   const Entries& metadata = {});
  void add_metadata(std::string_view name, const Entries& entries);  // keys unique
  void add_attachment(std::uint64_t log_time, std::string_view name, std::string_view media_type,
                      std::string_view bytes);
  // The message's sequence number counts the channel's messages from 0.
  void add_message(std::uint16_t channel, std::uint64_t log_time, std::uint64_t publish_time, std::string_view payload);

  void flush();  // closes the open chunk, if any
  void close();  // throws std::runtime_error if a write failed

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace ttf::recording::mcap
