// A log around given payloads: one chunk without compression and checksum, which is allowed, and which lets a fuzzer
// through to the records.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "recording/mcap/bytes.h"

namespace ttf::fuzz {

// (kind as a channel id, payload); payloads may be anything.
using Messages = std::vector<std::pair<std::uint8_t, std::string_view>>;

inline std::string mcap_around(const Messages& messages) {
  using namespace recording;
  std::string records;
  for (const auto& [kind, payload] : messages) {
    const std::size_t start = begin_record(records, Opcode::kMessage);
    put(records, std::uint16_t{kind});
    put(records, std::uint32_t{0});  // sequence
    put(records, std::uint64_t{0});  // log time
    put(records, std::uint64_t{0});  // publish time
    records += payload;
    end_record(records, start);
  }
  std::string log(kMcapMagic);
  const std::size_t header = begin_record(log, Opcode::kHeader);
  put_text(log, "ttfusion");
  put_text(log, "");
  end_record(log, header);
  const std::size_t chunk = begin_record(log, Opcode::kChunk);
  put(log, std::uint64_t{0});
  put(log, std::uint64_t{0});
  put(log, static_cast<std::uint64_t>(records.size()));
  put(log, std::uint32_t{0});  // no checksum
  put_text(log, "");           // no compression
  put(log, static_cast<std::uint64_t>(records.size()));
  log += records;
  end_record(log, chunk);
  return log;
}

}  // namespace ttf::fuzz
