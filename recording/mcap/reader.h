// Walks through the bytes of an MCAP file, trusting none of them. Private to the room.
//
// Every record must be consistent in itself (its fields fill its length exactly) before it is used. Where one
// is not, the walk looks for the next place at which a consistent record begins and goes on there, so that
// damage costs what it hit and no more. Chunks count only whole: their checksum must match before the first
// message is handed on.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace ttf::recording::mcap {

// What a walk finds, in file order. Views are valid during the call only.
class McapHandler {
 public:
  virtual ~McapHandler() = default;
  virtual void on_metadata(std::string_view name, const std::vector<std::pair<std::string, std::string>>& entries) = 0;
  virtual void on_attachment(std::string_view name, std::string_view media_type, std::string_view bytes) = 0;
  // A sound chunk, whose messages follow; its record's content lies in the walked bytes (recording/mcap/chunk.h opens
  // it).
  virtual void on_chunk(std::string_view) {}
  // False: the payload is unreadable.
  virtual bool on_message(std::uint16_t channel, std::uint64_t log_time, std::string_view payload) = 0;
};

struct McapReport {
  bool truncated = false;
  std::vector<std::string> warnings;  // without the file's name; bounded
  std::uint64_t chunks_read = 0, chunks_lost = 0;
};

// The profile in the header; empty where there is none or it is damaged.
std::string_view mcap_profile(std::string_view bytes);

// Precondition: `bytes` begins with the magic, or is a beginning of it.
McapReport walk_mcap(std::string_view bytes, McapHandler& handler);

}  // namespace ttf::recording::mcap
