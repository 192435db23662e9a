#include "recording/mcap/chunk.h"

#include <algorithm>

namespace ttf::recording::mcap {
namespace {

constexpr std::uint64_t kMaxChunkBytes = 64 * 1024 * 1024;  // far above any writer's chunks; bounds memory

}  // namespace

std::optional<McapRecord> record_at(std::string_view bytes, std::size_t at) {
  FieldReader fields(bytes.substr(at));
  const auto opcode = fields.take<std::uint8_t>();
  const auto length = fields.take<std::uint64_t>();
  const std::string_view content = fields.bytes(length);
  if (!fields.ok()) return std::nullopt;
  return McapRecord{opcode, content};
}

bool read_chunk(std::string_view content, ChunkFields& out) {
  FieldReader fields(content);
  fields.bytes(16);  // log times, which the messages have too
  out.uncompressed_size = fields.take<std::uint64_t>();
  out.crc = fields.take<std::uint32_t>();
  out.compression = fields.text();
  out.data = fields.bytes(fields.take<std::uint64_t>());
  return fields.done();
}

std::optional<std::string_view> ChunkOpener::open(std::string_view content, std::string& buffer) {
  ChunkFields chunk;
  if (!read_chunk(content, chunk)) return std::nullopt;
  std::string_view records = chunk.data;
  if (chunk.compression == "zstd" && chunk.uncompressed_size <= kMaxChunkBytes) {
    // Never smaller: growing fills with zeros, and damaged chunks may claim any size in turn.
    const auto claimed = static_cast<std::size_t>(chunk.uncompressed_size);
    buffer.resize(std::max(buffer.size(), claimed));
    const std::size_t size =
        ZSTD_decompressDCtx(zstd_.get(), buffer.data(), claimed, chunk.data.data(), chunk.data.size());
    records = ZSTD_isError(size) != 0 ? std::string_view{} : std::string_view(buffer).substr(0, size);
  } else if (!chunk.compression.empty()) {
    records = {};
  }
  if (records.size() != chunk.uncompressed_size || (chunk.crc != 0 && chunk.crc != crc_of(records)))
    return std::nullopt;
  return records;
}

}  // namespace ttf::recording::mcap
