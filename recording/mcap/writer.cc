#include "recording/mcap/writer.h"

#include <zstd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <stdexcept>

#include "core/check.h"
#include "core/errors.h"
#include "recording/mcap/bytes.h"

namespace ttf::recording::mcap {
namespace {

constexpr int kCompressionLevel = 1;  // most of the gain at a small part of the time

}  // namespace

struct McapWriter::Impl {
  struct Channel {
    bool declared = false;
    std::vector<std::pair<std::uint64_t, std::uint64_t>> index;  // log time, offset within the open chunk
    std::uint64_t messages = 0;
  };

  std::string path;
  std::FILE* file = nullptr;
  std::string error;         // the first failed write's
  std::uint64_t offset = 0;  // bytes written so far
  std::uint32_t data_crc = 0;
  bool closed = false;

  std::string record;  // scratch for everything outside chunks
  std::string chunk;   // records of the open chunk
  std::string compressed;
  ZSTD_CCtx* zstd = nullptr;
  std::uint64_t chunk_start = 0, chunk_end = 0;  // log times in the open chunk
  std::vector<Channel> channels;                 // by id - 1

  // The summary's groups, collected as the data is written.
  std::string schemas, channel_records, chunk_indexes, attachment_indexes, metadata_indexes;
  std::uint64_t messages = 0, first_time = 0, last_time = 0;
  std::uint32_t chunks = 0, attachments = 0, metadata = 0;
  std::uint16_t schema_count = 0, last_schema = 0;
  std::uint32_t channel_count = 0;

  void put_bytes(std::string_view bytes) {
    if (error.empty() && std::fwrite(bytes.data(), 1, bytes.size(), file) != bytes.size())
      error = system_message(errno);
    data_crc = crc_of(bytes, data_crc);
    offset += bytes.size();
  }
  void flush_file() {
    if (std::fflush(file) != 0 && error.empty()) error = system_message(errno);
  }
};

McapWriter::McapWriter(const std::string& path, std::string_view profile, std::string_view library)
    : impl_(std::make_unique<Impl>()) {
  impl_->path = path;
  impl_->file = std::fopen(path.c_str(), "wb");
  if (impl_->file == nullptr) throw std::runtime_error(path + ": cannot be created: " + system_message(errno));
  impl_->zstd = ZSTD_createCCtx();
  impl_->chunk.reserve(2 * kChunkBytes);
  impl_->compressed.resize(ZSTD_compressBound(2 * kChunkBytes));
  impl_->record.reserve(kChunkBytes);
  impl_->put_bytes(kMcapMagic);
  std::string& out = impl_->record;
  const std::size_t start = begin_record(out, Opcode::kHeader);
  put_text(out, profile);
  put_text(out, library);
  end_record(out, start);
  impl_->put_bytes(out);
}

McapWriter::~McapWriter() {
  if (impl_->file != nullptr) std::fclose(impl_->file);
  ZSTD_freeCCtx(impl_->zstd);
}

void McapWriter::add_schema(std::uint16_t id, std::string_view name, std::string_view encoding, std::string_view data) {
  TTF_CHECK(id > impl_->last_schema, "schema {} after {}", id, impl_->last_schema);
  std::string& out = impl_->record;
  out.clear();
  const std::size_t start = begin_record(out, Opcode::kSchema);
  put(out, id);
  put_text(out, name);
  put_text(out, encoding);
  put_text(out, data);
  end_record(out, start);
  impl_->put_bytes(out);
  impl_->schemas += out;
  ++impl_->schema_count;
  impl_->last_schema = id;
}

void McapWriter::add_channel(std::uint16_t id, std::uint16_t schema, std::string_view topic, std::string_view encoding,
                             const Entries& metadata) {
  TTF_CHECK(id > impl_->channels.size(), "channel {} after {}", id, impl_->channels.size());
  TTF_CHECK(schema >= 1 && schema <= impl_->last_schema, "schema {} of {}", schema, impl_->last_schema);
  std::string map;
  for (const auto& [key, value] : metadata) {
    put_text(map, key);
    put_text(map, value);
  }
  std::string& out = impl_->record;
  out.clear();
  const std::size_t start = begin_record(out, Opcode::kChannel);
  put(out, id);
  put(out, schema);
  put_text(out, topic);
  put_text(out, encoding);
  put_text(out, map);
  end_record(out, start);
  impl_->put_bytes(out);
  impl_->channel_records += out;
  impl_->channels.resize(id);
  impl_->channels.back().declared = true;
  impl_->channels.back().index.reserve(1024);
  ++impl_->channel_count;
}

void McapWriter::add_metadata(std::string_view name, const Entries& entries) {
  std::string map;
  for (const auto& [key, value] : entries) {
    put_text(map, key);
    put_text(map, value);
  }
  std::string& out = impl_->record;
  out.clear();
  std::size_t start = begin_record(out, Opcode::kMetadata);
  put_text(out, name);
  put_text(out, map);
  end_record(out, start);
  const std::uint64_t at = impl_->offset, length = out.size();
  impl_->put_bytes(out);
  std::string& index = impl_->metadata_indexes;
  start = begin_record(index, Opcode::kMetadataIndex);
  put(index, at);
  put(index, length);
  put_text(index, name);
  end_record(index, start);
  ++impl_->metadata;
}

void McapWriter::add_attachment(std::uint64_t log_time, std::string_view name, std::string_view media_type,
                                std::string_view bytes) {
  std::string& out = impl_->record;
  out.clear();
  std::size_t start = begin_record(out, Opcode::kAttachment);
  put(out, log_time);
  put(out, std::uint64_t{0});  // no creation time: files with the same content give the same log
  put_text(out, name);
  put_text(out, media_type);
  put(out, static_cast<std::uint64_t>(bytes.size()));
  out.append(bytes);
  put(out, crc_of(std::string_view(out).substr(start + 9)));
  end_record(out, start);
  const std::uint64_t at = impl_->offset, length = out.size();
  impl_->put_bytes(out);
  impl_->flush_file();
  std::string& index = impl_->attachment_indexes;
  start = begin_record(index, Opcode::kAttachmentIndex);
  put(index, at);
  put(index, length);
  put(index, log_time);
  put(index, std::uint64_t{0});
  put(index, static_cast<std::uint64_t>(bytes.size()));
  put_text(index, name);
  put_text(index, media_type);
  end_record(index, start);
  ++impl_->attachments;
}

void McapWriter::add_message(std::uint16_t channel, std::uint64_t log_time, std::uint64_t publish_time,
                             std::string_view payload) {
  TTF_CHECK(
      !impl_->closed && channel >= 1 && channel <= impl_->channels.size() && impl_->channels[channel - 1u].declared,
      "channel {} of {}, closed {}", channel, impl_->channels.size(), impl_->closed);
  Impl& s = *impl_;
  if (!s.chunk.empty() && std::max(s.chunk_end, log_time) - std::min(s.chunk_start, log_time) > kChunkSpan) flush();
  const bool first = s.chunk.empty();
  s.chunk_start = first ? log_time : std::min(s.chunk_start, log_time);
  s.chunk_end = first ? log_time : std::max(s.chunk_end, log_time);
  s.first_time = s.messages == 0 ? log_time : std::min(s.first_time, log_time);
  s.last_time = std::max(s.last_time, log_time);

  Impl::Channel& target = s.channels[channel - 1u];
  target.index.emplace_back(log_time, s.chunk.size());
  const std::size_t start = begin_record(s.chunk, Opcode::kMessage);
  put(s.chunk, channel);
  put(s.chunk, static_cast<std::uint32_t>(target.messages));
  put(s.chunk, log_time);
  put(s.chunk, publish_time);
  s.chunk.append(payload);
  end_record(s.chunk, start);
  ++target.messages;
  ++s.messages;
  if (s.chunk.size() >= kChunkBytes) flush();
}

void McapWriter::flush() {
  Impl& s = *impl_;
  if (s.chunk.empty()) return;
  s.compressed.resize(std::max(s.compressed.size(), ZSTD_compressBound(s.chunk.size())));
  const std::size_t size = ZSTD_compressCCtx(s.zstd, s.compressed.data(), s.compressed.size(), s.chunk.data(),
                                             s.chunk.size(), kCompressionLevel);
  TTF_CHECK(ZSTD_isError(size) == 0, "zstd: {}", ZSTD_getErrorName(size));

  std::string& out = s.record;
  out.clear();
  std::size_t start = begin_record(out, Opcode::kChunk);
  put(out, s.chunk_start);
  put(out, s.chunk_end);
  put(out, static_cast<std::uint64_t>(s.chunk.size()));
  put(out, crc_of(s.chunk));
  put_text(out, "zstd");
  put(out, static_cast<std::uint64_t>(size));
  out.append(s.compressed, 0, size);
  end_record(out, start);
  const std::uint64_t chunk_length = out.size();

  std::string& index = s.chunk_indexes;
  const std::size_t index_start = begin_record(index, Opcode::kChunkIndex);
  put(index, s.chunk_start);
  put(index, s.chunk_end);
  put(index, s.offset);
  put(index, chunk_length);
  const std::size_t map_at = index.size();
  put(index, std::uint32_t{0});
  for (std::size_t i = 0; i < s.channels.size(); ++i) {
    Impl::Channel& channel = s.channels[i];
    if (channel.index.empty()) continue;
    put(index, static_cast<std::uint16_t>(i + 1));
    put(index, s.offset + out.size());
    start = begin_record(out, Opcode::kMessageIndex);
    put(out, static_cast<std::uint16_t>(i + 1));
    put(out, static_cast<std::uint32_t>(channel.index.size() * 16));
    for (const auto& [time, at] : channel.index) {
      put(out, time);
      put(out, at);
    }
    end_record(out, start);
    channel.index.clear();
  }
  const auto map_bytes = static_cast<std::uint32_t>(index.size() - map_at - 4);
  std::memcpy(index.data() + map_at, &map_bytes, sizeof map_bytes);
  put(index, static_cast<std::uint64_t>(out.size() - chunk_length));
  put_text(index, "zstd");
  put(index, static_cast<std::uint64_t>(size));
  put(index, static_cast<std::uint64_t>(s.chunk.size()));
  end_record(index, index_start);

  s.put_bytes(out);
  s.flush_file();
  s.chunk.clear();
  ++s.chunks;
}

void McapWriter::close() {
  Impl& s = *impl_;
  if (s.closed) return;
  flush();
  s.closed = true;

  std::string out;
  std::size_t start = begin_record(out, Opcode::kDataEnd);
  put(out, s.data_crc);
  end_record(out, start);
  s.put_bytes(out);

  const std::uint64_t summary_start = s.offset;
  std::string statistics;
  start = begin_record(statistics, Opcode::kStatistics);
  put(statistics, s.messages);
  put(statistics, s.schema_count);
  put(statistics, s.channel_count);
  put(statistics, s.attachments);
  put(statistics, s.metadata);
  put(statistics, s.chunks);
  put(statistics, s.first_time);
  put(statistics, s.last_time);
  std::string counts;
  for (std::size_t i = 0; i < s.channels.size(); ++i) {
    if (s.channels[i].messages == 0) continue;
    put(counts, static_cast<std::uint16_t>(i + 1));
    put(counts, s.channels[i].messages);
  }
  put_text(statistics, counts);
  end_record(statistics, start);

  out.clear();
  std::string offsets;
  const std::pair<Opcode, const std::string*> groups[] = {{Opcode::kSchema, &s.schemas},
                                                          {Opcode::kChannel, &s.channel_records},
                                                          {Opcode::kStatistics, &statistics},
                                                          {Opcode::kChunkIndex, &s.chunk_indexes},
                                                          {Opcode::kAttachmentIndex, &s.attachment_indexes},
                                                          {Opcode::kMetadataIndex, &s.metadata_indexes}};
  for (const auto& [opcode, records] : groups) {
    if (records->empty()) continue;
    start = begin_record(offsets, Opcode::kSummaryOffset);
    put(offsets, static_cast<std::uint8_t>(opcode));
    put(offsets, static_cast<std::uint64_t>(summary_start + out.size()));
    put(offsets, static_cast<std::uint64_t>(records->size()));
    end_record(offsets, start);
    out += *records;
  }
  const std::uint64_t offsets_start = summary_start + out.size();
  out += offsets;
  start = begin_record(out, Opcode::kFooter);
  put(out, summary_start);
  put(out, offsets_start);
  // The checksum covers the summary and the footer up to itself, so the footer's length must be in place first.
  const std::uint64_t footer_length = 20;
  std::memcpy(out.data() + start + 1, &footer_length, sizeof footer_length);
  put(out, crc_of(out));
  s.put_bytes(out);
  s.put_bytes(kMcapMagic);
  if (std::fclose(s.file) != 0 && s.error.empty()) s.error = system_message(errno);
  s.file = nullptr;
  if (!s.error.empty()) throw std::runtime_error(s.path + ": cannot be written: " + s.error);
}

}  // namespace ttf::recording::mcap
