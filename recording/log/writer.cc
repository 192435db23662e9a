#include "recording/log/writer.h"

#include <fmt/format.h>
#include <google/protobuf/descriptor.h>

#include <algorithm>
#include <optional>

#include "core/check.h"
#include "recording/log/behind.h"
#include "recording/log/codec.h"
#include "recording/log/content_hash.h"
#include "recording/log/log.pb.h"
#include "recording/log/manifest_codec.h"
#include "recording/mcap/protobuf_schema.h"
#include "recording/mcap/writer.h"
#include "recording/records/fields.h"

namespace ttf::recording::log {
namespace {

constexpr std::uint16_t kLastKind = 255;  // kinds are numbered in a byte

std::uint64_t unsigned_time(std::int64_t ns) { return static_cast<std::uint64_t>(std::max<std::int64_t>(ns, 0)); }

void add_kind(mcap::McapWriter& mcap, records::RecordKind kind, std::string_view message) {
  const auto* type = ttfusion::Stamp::descriptor()->file()->FindMessageTypeByName(std::string(message));
  TTF_CHECK(type != nullptr, "the schema has no message {}", message);
  const auto id = static_cast<std::uint16_t>(kind);
  mcap.add_schema(id, type->full_name(), "protobuf", mcap::protobuf_schema(*type));
  mcap.add_channel(id, id, records::topic_of(kind), "protobuf");
}

}  // namespace

std::string ContentHash::text(std::uint64_t hash) { return fmt::format("{:016x}", hash); }

struct LogWriter::Impl {
  explicit Impl(const std::string& path) : mcap(path, kLogProfile, "ttfusion") {}

  void write(const Encoded& record) {
    const auto kind = static_cast<std::uint8_t>(record.kind);
    const LogMessage message{kind, unsigned_time(record.times.log), unsigned_time(record.times.publish),
                             record.payload};
    if (behind)
      behind->add(message);
    else
      store(message);
  }

  void store(const LogMessage& message) {
    hash.add(message.log_time, message.kind, message.payload);
    mcap.add_message(message.kind, message.log_time, message.publish_time, message.payload);
    ++records;
  }

  mcap::McapWriter mcap;
  ContentHash hash;
  std::uint64_t records = 0;
  bool closed = false;
  std::uint16_t foreign = kLastKind;  // the last foreign channel
  std::optional<LogBehind> behind;    // last, so that its thread ends before the members that it writes to
};

LogWriter::LogWriter(const std::string& path, const LogManifest& manifest, Writing writing)
    : impl_(std::make_unique<Impl>(path)), encoder_(encoder([this](const Encoded& record) { impl_->write(record); })) {
  mcap::McapWriter& mcap = impl_->mcap;
  mcap.add_metadata(kManifestName, manifest_entries(manifest));
  records::for_each_kind(
      [&]<class Record>() { add_kind(mcap, records::kKindOf<Record>, records::kDescription<Record>.message); });
  if (writing == Writing::kBehind) impl_->behind.emplace([this](const LogMessage& message) { impl_->store(message); });
}

LogWriter::~LogWriter() {
  try {
    close();
  } catch (const std::exception&) {
    // A destructor cannot report the failure; callers that need it call close().
  }
}

void LogWriter::attach(std::string_view name, std::string_view media_type, std::string_view bytes) {
  impl_->mcap.add_attachment(0, name, media_type, bytes);
}

std::uint16_t LogWriter::add_foreign_channel(std::string_view topic, const google::protobuf::Descriptor& type,
                                             const mcap::McapWriter::Entries& metadata) {
  const std::uint16_t id = ++impl_->foreign;
  impl_->mcap.add_schema(id, type.full_name(), "protobuf", mcap::protobuf_schema(type));
  impl_->mcap.add_channel(id, id, topic, "protobuf", metadata);
  return id;
}

void LogWriter::add_foreign_metadata(std::string_view name, const mcap::McapWriter::Entries& entries) {
  impl_->mcap.add_metadata(name, entries);
}

void LogWriter::add_foreign(std::uint16_t channel, TrueTime at, std::string_view message) {
  TTF_CHECK(!impl_->behind, "a foreign message in a log that is written behind");
  impl_->mcap.add_message(channel, unsigned_time(at.ns), unsigned_time(at.ns), message);
}

void LogWriter::close() {
  if (impl_->closed) return;
  impl_->closed = true;
  if (impl_->behind) impl_->behind->close();
  impl_->mcap.flush();
  impl_->mcap.add_metadata(kResultName,
                           {{"content_hash", content_hash_text()}, {"records", std::to_string(impl_->records)}});
  impl_->mcap.close();
}

std::uint64_t LogWriter::content_hash() const { return impl_->hash.value(); }
std::string LogWriter::content_hash_text() const { return ContentHash::text(content_hash()); }

}  // namespace ttf::recording::log
