#include "recording/mcap/reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <vector>

#include "recording/mcap/bytes.h"
#include "recording/mcap/chunk.h"
#include "recording/mcap/metadata.h"

namespace ttf::recording::mcap {
namespace {

constexpr std::size_t kMaxWarnings = 20;
constexpr std::size_t kFooterBytes = kRecordHead + 20;

struct AttachmentFields {
  std::string_view name, media_type, data;
  std::uint32_t crc = 0;
};

bool read_attachment(std::string_view content, AttachmentFields& out) {
  FieldReader fields(content);
  fields.bytes(16);  // log and creation time
  out.name = fields.text();
  out.media_type = fields.text();
  out.data = fields.bytes(fields.take<std::uint64_t>());
  out.crc = fields.take<std::uint32_t>();
  return fields.done();
}

// Returns whether a record's fields fill it exactly. The time taken grows with the number of fields, not with
// their lengths.
bool consistent(const McapRecord& record) {
  FieldReader fields(record.content);
  switch (static_cast<Opcode>(record.opcode)) {
    case Opcode::kHeader:
      fields.text();
      fields.text();
      return fields.done();
    case Opcode::kFooter: return record.content.size() == 20;
    case Opcode::kDataEnd: return record.content.size() == 4;
    case Opcode::kSummaryOffset: return record.content.size() == 17;
    case Opcode::kSchema:
      fields.take<std::uint16_t>();
      for (int i = 0; i < 3; ++i) fields.text();
      return fields.done();
    case Opcode::kChannel:
      fields.take<std::uint32_t>();
      for (int i = 0; i < 3; ++i) fields.text();
      return fields.done();
    case Opcode::kChunk: {
      ChunkFields chunk;
      return read_chunk(record.content, chunk);
    }
    case Opcode::kMessageIndex: {
      fields.take<std::uint16_t>();
      const std::string_view entries = fields.text();
      return fields.done() && entries.size() % 16 == 0;
    }
    case Opcode::kChunkIndex: {
      fields.bytes(32);
      const std::string_view offsets = fields.text();
      fields.take<std::uint64_t>();
      fields.text();
      fields.bytes(16);
      return fields.done() && offsets.size() % 10 == 0;
    }
    case Opcode::kAttachment: {
      AttachmentFields attachment;
      return read_attachment(record.content, attachment);
    }
    case Opcode::kAttachmentIndex:
      fields.bytes(40);
      fields.text();
      fields.text();
      return fields.done();
    case Opcode::kStatistics: {
      fields.bytes(42);
      const std::string_view counts = fields.text();
      return fields.done() && counts.size() % 10 == 0;
    }
    case Opcode::kMetadata: {
      std::string_view name;
      return read_metadata(record.content, name, nullptr);
    }
    case Opcode::kMetadataIndex:
      fields.bytes(16);
      fields.text();
      return fields.done();
    case Opcode::kMessage: return false;  // valid in chunks only, where a checksum covers it
  }
  return false;
}

bool known(std::uint8_t opcode) {
  return opcode >= static_cast<std::uint8_t>(Opcode::kHeader) && opcode <= static_cast<std::uint8_t>(Opcode::kDataEnd);
}

// Returns whether the file has its last record, whether or not earlier bytes are damaged.
bool has_end(std::string_view bytes) {
  if (bytes.size() < kFooterBytes + kMcapMagic.size() || bytes.substr(bytes.size() - 8) != kMcapMagic) return false;
  const auto footer = record_at(bytes, bytes.size() - 8 - kFooterBytes);
  return footer && footer->opcode == static_cast<std::uint8_t>(Opcode::kFooter) && consistent(*footer);
}

class Walk {
 public:
  Walk(std::string_view bytes, McapHandler& handler) : bytes_(bytes), handler_(handler) {}

  McapReport run() {
    const bool ended = has_end(bytes_);
    std::size_t at = kMcapMagic.size();
    bool finished = false;
    while (!finished && at < bytes_.size()) {
      const auto record = record_at(bytes_, at);
      if (record && !known(record->opcode) && record->opcode != 0) {
        warn("the record of unknown type {} at byte {} is left out", record->opcode, at);
      } else if (!record || !is_consistent(*record, at)) {
        const std::size_t next = next_record(at + 1);
        if (next >= bytes_.size() && !ended) break;  // the torn tail
        if (bytes_[at] == static_cast<char>(Opcode::kChunk)) ++report_.chunks_lost;
        warn("the record at byte {} is damaged and left out", at);
        at = next;
        continue;
      } else {
        finished = take(*record, at);
      }
      at += kRecordHead + record->content.size();
    }
    if (!ended) {
      report_.truncated = true;
      warn("the log was cut off at byte {}; everything up to byte {} is read", bytes_.size(),
           std::min(at, bytes_.size()));
    } else if (finished && at + kMcapMagic.size() != bytes_.size()) {
      warn("{} bytes follow the end", bytes_.size() - at - kMcapMagic.size());
    }
    if (suppressed_ > 0) report_.warnings.push_back(fmt::format("{} more like these", suppressed_));
    return std::move(report_);
  }

 private:
  template <class... Args> void warn(fmt::format_string<Args...> text, Args&&... args) {
    if (report_.warnings.size() < kMaxWarnings)
      report_.warnings.push_back(fmt::format(text, std::forward<Args>(args)...));
    else
      ++suppressed_;
  }

  // Behind damage, all metadata records are looked for at once.
  bool is_consistent(const McapRecord& record, std::size_t at) const {
    if (record.opcode == static_cast<std::uint8_t>(Opcode::kMetadata) && metadata_)
      return std::binary_search(metadata_->begin(), metadata_->end(), at);
    return consistent(record);
  }

  std::size_t next_record(std::size_t from) {
    if (!metadata_) metadata_ = consistent_metadata(bytes_, from, report_.work);
    for (std::size_t at = from; at + kRecordHead < bytes_.size(); ++at) {
      ++report_.work;
      if (!known(static_cast<std::uint8_t>(bytes_[at])) || bytes_[at] == static_cast<char>(Opcode::kHeader)) continue;
      if (bytes_.substr(at + 5, 4) != std::string_view("\0\0\0\0", 4)) continue;  // no record has 4 GiB
      const auto record = record_at(bytes_, at);
      if (record && is_consistent(*record, at)) return at;
    }
    return bytes_.size();
  }

  // Returns the CRC of all bytes before `at`, which never decreases.
  std::uint32_t crc_before(std::size_t at) {
    report_.work += at - summed_;
    crc_ = crc_of(bytes_.substr(summed_, at - summed_), crc_);
    summed_ = at;
    return crc_;
  }

  // Returns true after the footer.
  bool take(const McapRecord& record, std::size_t at) {
    switch (static_cast<Opcode>(record.opcode)) {
      case Opcode::kChunk: take_chunk(record.content, at); return false;
      case Opcode::kAttachment: {
        AttachmentFields attachment;
        read_attachment(record.content, attachment);
        const std::string_view covered = record.content.substr(0, record.content.size() - 4);
        if (attachment.crc != 0 && attachment.crc != crc_of(covered))
          warn("the attachment at byte {} is damaged (checksum) and left out", at);
        else
          handler_.on_attachment(attachment.name, attachment.media_type, attachment.data);
        return false;
      }
      case Opcode::kMetadata: {
        std::string_view name;
        std::vector<std::pair<std::string, std::string>> entries;
        read_metadata(record.content, name, &entries);
        handler_.on_metadata(name, entries);
        return false;
      }
      case Opcode::kDataEnd: {
        const auto stated = FieldReader(record.content).take<std::uint32_t>();
        if (stated != 0 && report_.warnings.empty() && stated != crc_before(at))
          warn("bytes outside the chunks are damaged (checksum of the data section); all records are read");
        return false;
      }
      case Opcode::kFooter: {
        FieldReader fields(record.content);
        const auto summary_start = fields.take<std::uint64_t>();
        fields.take<std::uint64_t>();
        const auto stated = fields.take<std::uint32_t>();
        const std::size_t crc_at = at + kFooterBytes - 4;
        const bool sound =
            summary_start <= at && (stated == 0 || crc_of(bytes_.substr(static_cast<std::size_t>(summary_start),
                                                                        crc_at - summary_start)) == stated);
        if (!sound) warn("the index at the end is damaged (checksum); all records are read");
        return true;
      }
      case Opcode::kSchema:
      case Opcode::kChannel: declare(record); return false;
      case Opcode::kHeader:
      case Opcode::kMessage:
      case Opcode::kMessageIndex:
      case Opcode::kChunkIndex:
      case Opcode::kAttachmentIndex:
      case Opcode::kStatistics:
      case Opcode::kMetadataIndex:
      case Opcode::kSummaryOffset: return false;  // for readers that seek
    }
    return false;
  }

  void declare(const McapRecord& record) {
    FieldReader fields(record.content);
    const auto id = fields.take<std::uint16_t>();
    if (record.opcode == static_cast<std::uint8_t>(Opcode::kSchema)) {
      const std::string_view name = fields.text();
      if (fields.ok()) handler_.on_schema(id, name);
    } else {
      const auto schema = fields.take<std::uint16_t>();
      if (fields.ok()) handler_.on_channel(id, schema);
    }
  }

  void take_chunk(std::string_view content, std::size_t at) {
    const auto records = opener_.open(content, buffer_);
    if (!records) {
      ++report_.chunks_lost;
      warn("the chunk at byte {} is damaged and left out", at);
      return;
    }
    ++report_.chunks_read;
    handler_.on_chunk(content);
    const std::uint64_t unreadable = for_each_message(
        *records,
        [this](std::uint16_t channel, std::uint64_t log_time, std::string_view payload) {
          return handler_.on_message(channel, log_time, payload);
        },
        [this](const McapRecord& declaration) { declare(declaration); });
    if (unreadable > 0) warn("the chunk at byte {} holds {} unreadable messages, which are left out", at, unreadable);
  }

  std::string_view bytes_;
  McapHandler& handler_;
  ChunkOpener opener_;
  std::string buffer_;
  McapReport report_;
  std::uint64_t suppressed_ = 0;
  std::optional<std::vector<std::size_t>> metadata_;  // behind the first damage: where consistent ones begin
  std::size_t summed_ = 0;
  std::uint32_t crc_ = 0;  // sums the bytes before summed_
};

}  // namespace

std::string_view mcap_profile(std::string_view bytes) {
  if (bytes.size() < kMcapMagic.size()) return {};
  const auto header = record_at(bytes, kMcapMagic.size());
  if (!header || header->opcode != static_cast<std::uint8_t>(Opcode::kHeader) || !consistent(*header)) return {};
  return FieldReader(header->content).text();
}

McapReport walk_mcap(std::string_view bytes, McapHandler& handler) { return Walk(bytes, handler).run(); }

}  // namespace ttf::recording::mcap
