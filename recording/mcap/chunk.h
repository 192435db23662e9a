// The parts of an MCAP file that reading a log needs: its records, and the messages in its chunks. Private to
// the room.
//
// The bytes are not trusted: a record's fields must fill it exactly, and a chunk's checksum must match before
// any of its messages is handed on.
#pragma once

#include <zstd.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "recording/mcap/bytes.h"

namespace ttf::recording::mcap {

inline constexpr std::size_t kRecordHead = 9;  // opcode and length

struct McapRecord {
  std::uint8_t opcode = 0;
  std::string_view content;
};
// Returns the record that begins at `at`, if it ends within the bytes.
std::optional<McapRecord> record_at(std::string_view bytes, std::size_t at);

struct ChunkFields {
  std::uint64_t uncompressed_size = 0;
  std::uint32_t crc = 0;
  std::string_view compression, data;
};
bool read_chunk(std::string_view content, ChunkFields& out);

// Decompresses chunks, one after the other.
class ChunkOpener {
 public:
  // Returns the records in a chunk's content; absent if they are damaged. Valid as long as `buffer` and
  // `content` are.
  std::optional<std::string_view> open(std::string_view content, std::string& buffer);

 private:
  struct Free {
    void operator()(ZSTD_DCtx* context) const { ZSTD_freeDCtx(context); }
  };
  std::unique_ptr<ZSTD_DCtx, Free> zstd_{ZSTD_createDCtx()};
};

// Calls `message(channel, log time, payload)` for every message among a chunk's records, in their order.
// `message` returns false if the payload is unreadable. Returns how many messages were unreadable; a torn
// record counts as one. Calls `declaration(record)` for every schema and channel among them.
template <class Message, class Declaration>
std::uint64_t for_each_message(std::string_view records, Message&& message, Declaration&& declaration) {
  std::uint64_t unreadable = 0;
  for (std::size_t offset = 0; offset < records.size();) {
    const auto record = record_at(records, offset);
    if (!record) return unreadable + 1;
    offset += kRecordHead + record->content.size();
    if (record->opcode == static_cast<std::uint8_t>(Opcode::kSchema) ||
        record->opcode == static_cast<std::uint8_t>(Opcode::kChannel))
      declaration(*record);
    if (record->opcode != static_cast<std::uint8_t>(Opcode::kMessage)) continue;
    FieldReader fields(record->content);
    const auto channel = fields.take<std::uint16_t>();
    fields.take<std::uint32_t>();  // sequence
    const auto log_time = fields.take<std::uint64_t>();
    fields.take<std::uint64_t>();  // publish time, which the payload has too
    if (!fields.ok() || !message(channel, log_time, fields.rest())) ++unreadable;
  }
  return unreadable;
}
template <class Message> std::uint64_t for_each_message(std::string_view records, Message&& message) {
  return for_each_message(records, message, [](const McapRecord&) {});
}

}  // namespace ttf::recording::mcap
