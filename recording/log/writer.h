// The log of a drive: every record as one MCAP message with a protobuf payload (recording/log/log.proto).
//
// docs/reference/log_format.md describes the file. One thread may write at a time. The file has no dates and no
// addresses: the same records give the same bytes. log_time is the record's true time: Stamp::true_time, else
// the end or the instant that the record names. publish_time is the node's global time if it has one. Both are
// 0 for times before the start of the drive, which the payload has exactly.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "core/time.h"
#include "recording/log/manifest.h"
#include "recording/mcap/writer.h"
#include "recording/records/every.h"

namespace google::protobuf {
class Descriptor;
}  // namespace google::protobuf

namespace ttf::recording::log {

class LogWriter final : public records::Every<LogWriter> {
 public:
  enum class Writing : std::uint8_t {
    kAtOnce,  // by the thread that records
    kBehind,  // by a thread of its own, so that recording in real time never waits for a disk or for
              // compression
  };
  // Opens `path` and writes manifest, schemas and channels. Throws std::runtime_error if the file cannot be
  // created.
  LogWriter(const std::string& path, const LogManifest& manifest, Writing writing = Writing::kAtOnce);
  ~LogWriter() override;  // closes and ignores a failure; call close() to get it
  LogWriter(const LogWriter&) = delete;
  LogWriter& operator=(const LogWriter&) = delete;

  // Puts a file (schedule, scenario) into the log, before the first record. Names should be unique.
  void attach(std::string_view name, std::string_view media_type, std::string_view bytes);

  // A channel of other messages in the same file, such as an OSI trace. Readers of logs pass over it, and the content
  // hash does not cover it. Channels are declared before the first record. Only for a log that is written at once.
  std::uint16_t add_foreign_channel(std::string_view topic, const google::protobuf::Descriptor& type,
                                    const mcap::McapWriter::Entries& metadata);
  void add_foreign_metadata(std::string_view name, const mcap::McapWriter::Entries& entries);
  void add_foreign(std::uint16_t channel, TrueTime at, std::string_view message);

  // Writes the last chunk and the summary. Throws std::runtime_error if a write failed (disk full). A second
  // call does nothing; no record may follow.
  void close();

  // Returns the hash over all records so far in canonical order (recording/log/content_hash.h). A log that is
  // written behind must be closed first.
  std::uint64_t content_hash() const;
  // The hash as the program prints it: 16 hex digits.
  std::string content_hash_text() const;

  template <class Record> void each(const Record& record) { encoder_->on(record); }

 private:
  struct Impl;

  std::unique_ptr<Impl> impl_;
  std::unique_ptr<records::Sink> encoder_;  // writes to impl_
};

}  // namespace ttf::recording::log
