// Bytes of MCAP: opcodes, little-endian fields out and in (https://mcap.dev/spec).
#pragma once

#include <zlib.h>

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

namespace ttf::recording::mcap {

static_assert(std::endian::native == std::endian::little, "fields are copied as they are in memory");

inline constexpr std::string_view kMcapMagic{"\x89MCAP0\r\n", 8};

enum class Opcode : std::uint8_t {
  kHeader = 1,
  kFooter,
  kSchema,
  kChannel,
  kMessage,
  kChunk,
  kMessageIndex,
  kChunkIndex,
  kAttachment,
  kAttachmentIndex,
  kStatistics,
  kMetadata,
  kMetadataIndex,
  kSummaryOffset,
  kDataEnd,
};

// Returns the CRC-32 of ISO 3309 of `bytes`, continuing from `crc`, the CRC of the bytes before them.
inline std::uint32_t crc_of(std::string_view bytes, std::uint32_t crc = 0) {
  return static_cast<std::uint32_t>(crc32_z(crc, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

template <class Int> void put(std::string& out, Int value) {
  char bytes[sizeof(Int)];
  std::memcpy(bytes, &value, sizeof(Int));
  out.append(bytes, sizeof(Int));
}

inline void put_text(std::string& out, std::string_view text) {
  put(out, static_cast<std::uint32_t>(text.size()));
  out.append(text);
}

// Begins a record and returns where it starts; end_record fills in its length.
inline std::size_t begin_record(std::string& out, Opcode opcode) {
  const std::size_t start = out.size();
  out.push_back(static_cast<char>(opcode));
  put(out, std::uint64_t{0});
  return start;
}
inline void end_record(std::string& out, std::size_t start) {
  const std::uint64_t length = out.size() - start - 9;
  std::memcpy(out.data() + start + 1, &length, sizeof length);
}

// Takes fields off the front of untrusted bytes. After the first field that does not fit, ok() is false and all
// further fields read as zero or empty.
class FieldReader {
 public:
  explicit FieldReader(std::string_view bytes) : rest_(bytes) {}

  template <class Int> Int take() {
    Int value{};
    const std::string_view field = bytes(sizeof(Int));
    if (!field.empty()) std::memcpy(&value, field.data(), sizeof(Int));
    return value;
  }
  std::string_view bytes(std::uint64_t count) {
    if (!ok_ || count > rest_.size()) {
      ok_ = false;
      return {};
    }
    const std::string_view field = rest_.substr(0, static_cast<std::size_t>(count));
    rest_.remove_prefix(static_cast<std::size_t>(count));
    return field;
  }
  std::string_view text() { return bytes(take<std::uint32_t>()); }

  bool ok() const { return ok_; }
  bool done() const { return ok_ && rest_.empty(); }  // every byte was used, and no field was cut off
  std::string_view rest() const { return rest_; }

 private:
  std::string_view rest_;
  bool ok_ = true;
};

}  // namespace ttf::recording::mcap
