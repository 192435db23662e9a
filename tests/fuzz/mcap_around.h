// A log around given payloads: one chunk without compression and checksum. This is allowed, and lets a fuzzer
// reach the records.
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
  using namespace recording::mcap;
  std::string records;
  for (const auto& [kind, payload] : messages) {
    const std::size_t start = begin_record(records, recording::mcap::Opcode::kMessage);
    recording::mcap::put(records, std::uint16_t{kind});
    recording::mcap::put(records, std::uint32_t{0});  // sequence
    recording::mcap::put(records, std::uint64_t{0});  // log time
    recording::mcap::put(records, std::uint64_t{0});  // publish time
    records += payload;
    recording::mcap::end_record(records, start);
  }
  std::string log(recording::mcap::kMcapMagic);
  const std::size_t header = begin_record(log, recording::mcap::Opcode::kHeader);
  recording::mcap::put_text(log, "ttfusion");
  recording::mcap::put_text(log, "");
  recording::mcap::end_record(log, header);
  const std::size_t chunk = begin_record(log, recording::mcap::Opcode::kChunk);
  recording::mcap::put(log, std::uint64_t{0});
  recording::mcap::put(log, std::uint64_t{0});
  recording::mcap::put(log, static_cast<std::uint64_t>(records.size()));
  recording::mcap::put(log, std::uint32_t{0});  // no checksum
  recording::mcap::put_text(log, "");           // no compression
  recording::mcap::put(log, static_cast<std::uint64_t>(records.size()));
  log += records;
  recording::mcap::end_record(log, chunk);
  return log;
}

}  // namespace ttf::fuzz
