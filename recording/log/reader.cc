#include "recording/log/reader.h"

#include <fmt/format.h>

#include <charconv>
#include <set>

#include "core/errors.h"
#include "core/file_bytes.h"
#include "recording/log/codec.h"
#include "recording/log/manifest_codec.h"
#include "recording/mcap/bytes.h"
#include "recording/mcap/reader.h"

namespace ttf::recording::log {
namespace {

constexpr std::string_view kOwnSchemas = "ttfusion.";

// A channel of another schema is passed over: an OSI trace may be in the same file.
class Collector final : public mcap::McapHandler {
 public:
  Collector(LogInfo& info, records::Sink& sink, const ChunkListener& on_chunk)
      : info_(info), sink_(sink), on_chunk_(on_chunk) {}

  void on_metadata(std::string_view name, const ManifestEntries& entries) override {
    if (name == kManifestName && !has_manifest_) {
      has_manifest_ = true;
      info_.manifest_sound = read_manifest(entries, info_.manifest);
    } else if (name == kResultName) {
      for (const auto& [key, value] : entries) {
        std::uint64_t hash = 0;
        const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), hash, 16);
        if (key == "content_hash" && error == std::errc{} && end == value.data() + value.size())
          info_.stated_content_hash = hash;
      }
    }
  }
  void on_attachment(std::string_view name, std::string_view media_type, std::string_view bytes) override {
    info_.attachments.push_back({std::string(name), std::string(media_type), std::string(bytes)});
  }
  void on_chunk(std::string_view content) override {
    if (on_chunk_) on_chunk_(content);
  }
  void on_schema(std::uint16_t id, std::string_view name) override {
    if (!name.starts_with(kOwnSchemas)) foreign_schemas_.insert(id);
  }
  void on_channel(std::uint16_t id, std::uint16_t schema) override {
    if (!records::is_kind(id) && foreign_schemas_.contains(schema)) foreign_channels_.insert(id);
  }
  bool on_message(std::uint16_t channel, std::uint64_t log_time, std::string_view payload) override {
    if (!records::is_kind(channel)) return foreign_channels_.contains(channel);
    const auto kind = static_cast<records::RecordKind>(channel);
    if (!decoder_.decode(kind, payload, sink_)) return false;
    info_.records.add(log_time, static_cast<std::uint8_t>(kind), payload);
    ++info_.counts[channel - 1u];
    return true;
  }

  bool has_manifest() const { return has_manifest_; }

 private:
  LogInfo& info_;
  records::Sink& sink_;
  const ChunkListener& on_chunk_;
  Decoder decoder_;
  bool has_manifest_ = false;
  std::set<std::uint16_t> foreign_schemas_, foreign_channels_;
};

void check_is_log(std::string_view bytes, const std::string& name) {
  if (!bytes.starts_with(mcap::kMcapMagic))
    throw InputError({name, 0, "", "", "is not a log: it does not begin as an MCAP file does"});
  // A log with a damaged header is still read if its manifest is there; a sound header of another program is an
  // error.
  const std::string_view profile = mcap::mcap_profile(bytes);
  if (!profile.empty() && profile != kLogProfile && bytes.find(kManifestName) == std::string_view::npos)
    throw InputError({name, 0, "profile", std::string(profile), "is an MCAP file, but its profile must be ttfusion"});
}

}  // namespace

LogInfo read_log_bytes(std::string_view bytes, const std::string& name, records::Sink& sink,
                       const ChunkListener& on_chunk) {
  check_is_log(bytes, name);
  LogInfo info;
  Collector collector(info, sink, on_chunk);
  mcap::McapReport report = walk_mcap(bytes, collector);
  info.truncated = report.truncated;
  info.chunks_read = report.chunks_read;
  info.chunks_lost = report.chunks_lost;
  info.content_hash = info.records.value();
  if (!collector.has_manifest() && report.chunks_read + report.chunks_lost == 0)
    throw InputError(
        {name, 0, "", "",
         fmt::format("holds only the beginning of a log: {} bytes, no manifest, no record", bytes.size())});
  if (!collector.has_manifest())
    report.warnings.push_back("the manifest is missing: names and seed are unknown");
  else if (!info.manifest_sound)
    report.warnings.push_back("the manifest is damaged: names and seed may be wrong");
  if (report.warnings.empty() && info.stated_content_hash != info.content_hash)
    report.warnings.push_back("the stated content hash differs from that of the records");
  for (const std::string& warning : report.warnings) {
    if (!info.warning.empty()) info.warning += '\n';
    info.warning += name + ": " + warning;
  }
  return info;
}

LogInfo read_log(const std::string& path, records::Sink& sink) { return read_log_bytes(read_file(path), path, sink); }

}  // namespace ttf::recording::log
