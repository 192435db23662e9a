// Records to payloads of the log and back, as recording/records/fields.h describes their fields. Payloads are messages of
// recording/log/log.proto.
//
// The encoder writes each payload into the same memory. It uses no heap once that has the largest payload's size. A
// decoder checks that every number fits its field's type and range, that lists have their lengths, and that texts are
// UTF-8. On failure it returns false and calls no sink.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string_view>

#include "recording/records/kinds.h"
#include "recording/records/records.h"

namespace ttf::recording::log {

// The two stamps that MCAP keeps per message, before negative values are clamped to 0.
struct LogTimes {
  std::int64_t log = 0;
  std::int64_t publish = 0;
};

struct Encoded {
  records::RecordKind kind{};
  std::string_view payload;  // valid during the call
  LogTimes times;
};
// Encodes every record that it receives, and hands it to `out`.
std::unique_ptr<records::Sink> encoder(std::function<void(const Encoded&)> out);

class Decoder {
 public:
  Decoder();
  ~Decoder();

  // Parses one payload and hands the record to `sink`. The record's texts and bytes are parts of `bytes`.
  bool decode(records::RecordKind kind, std::string_view bytes, records::Sink& sink);

 private:
  struct Lists;  // storage for a record's lists during the call of the sink

  std::unique_ptr<Lists> lists_;
};

}  // namespace ttf::recording::log
