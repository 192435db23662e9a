// Walks through the untrusted bytes of an MCAP file. Private to the module.
//
// Every record must be consistent (its fields fill its length exactly) before it is used. After an inconsistent
// one, the walk goes on at the next place where a consistent record begins, so damage costs only the damaged
// records. A chunk's checksum must match before its first message is handed on. The time grows with the file's size
// and that of its chunks' records, for any bytes.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace ttf::recording::mcap {

// Receives the contents of a walk, in file order. Views are valid during the call only.
class McapHandler {
 public:
  virtual ~McapHandler() = default;
  virtual void on_metadata(std::string_view name, const std::vector<std::pair<std::string, std::string>>& entries) = 0;
  virtual void on_attachment(std::string_view name, std::string_view media_type, std::string_view bytes) = 0;
  // Declarations, which stand outside of chunks or in them. A summary repeats them.
  virtual void on_schema(std::uint16_t /*id*/, std::string_view /*name*/) {}
  virtual void on_channel(std::uint16_t /*id*/, std::uint16_t /*schema*/) {}
  // A sound chunk; its messages follow. The argument is the record's content within the walked bytes
  // (recording/mcap/chunk.h opens it).
  virtual void on_chunk(std::string_view) {}
  // Returns false if the payload is unreadable.
  virtual bool on_message(std::uint16_t channel, std::uint64_t log_time, std::string_view payload) = 0;
};

struct McapReport {
  bool truncated = false;
  std::vector<std::string> warnings;  // without the file's name; at most 21
  std::uint64_t chunks_read = 0, chunks_lost = 0;
  // The search behind damage looked at so many bytes, candidates and entries. Sums of the whole file count, too.
  std::uint64_t work = 0;
};

// Returns the profile in the header; empty if the header has none or is damaged.
std::string_view mcap_profile(std::string_view bytes);

// Precondition: `bytes` begins with the magic, or is a beginning of it.
McapReport walk_mcap(std::string_view bytes, McapHandler& handler);

}  // namespace ttf::recording::mcap
