#include "recording/osi/messages.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <map>
#include <optional>
#include <utility>

#include "core/counted.h"
#include "recording/mcap/bytes.h"
#include "recording/mcap/chunk.h"
#include "recording/mcap/reader.h"
#include "recording/osi/osi.pb.h"

namespace ttf::recording::osi {
namespace {

constexpr std::string_view kTruthSchema = "osi3.GroundTruth", kViewSchema = "osi3.SensorView";

[[noreturn]] void refuse(const std::string& name, std::string why) {
  throw InputError({name, 0, "", "", std::move(why)});
}

// MCAP.

// Takes the messages of every OSI channel.
class Channels final : public mcap::McapHandler {
 public:
  void on_metadata(std::string_view, const std::vector<std::pair<std::string, std::string>>&) override {}
  void on_attachment(std::string_view, std::string_view, std::string_view) override {}
  void on_schema(std::uint16_t id, std::string_view name) override { schemas_[id] = name; }
  void on_channel(std::uint16_t id, std::uint16_t schema) override {
    if (const auto found = schemas_.find(schema); found != schemas_.end()) types[id] = found->second;
  }
  bool on_message(std::uint16_t channel, std::uint64_t, std::string_view payload) override {
    const auto type = types.find(channel);
    if (type != types.end() && (type->second == kTruthSchema || type->second == kViewSchema))
      messages[channel].emplace_back(payload);
    return true;
  }

  std::map<std::uint16_t, std::string> types;  // by channel
  std::map<std::uint16_t, std::vector<std::string>> messages;

 private:
  std::map<std::uint16_t, std::string> schemas_;
};

// Returns a chunk's compression that we cannot undo; empty if there is none.
std::string foreign_compression(std::string_view bytes) {
  std::size_t at = mcap::kMcapMagic.size();
  while (const auto record = mcap::record_at(bytes, at)) {
    mcap::ChunkFields chunk;
    if (record->opcode == static_cast<std::uint8_t>(mcap::Opcode::kChunk) && mcap::read_chunk(record->content, chunk))
      return chunk.compression.empty() || chunk.compression == "zstd" ? "" : std::string(chunk.compression);
    at += mcap::kRecordHead + record->content.size();
  }
  return "";
}

// Returns the only channel of the type; 0 without any.
std::uint16_t channel_of(const Channels& channels, std::string_view type, const std::string& name) {
  std::uint16_t found = 0;
  std::size_t count = 0;
  for (const auto& [id, of] : channels.types)
    if (of == type && ++count == 1) found = id;
  if (count > 1) refuse(name, fmt::format("must have one channel of {}, and has {}", type, count));
  return found;
}

TraceMessages from_mcap(std::string_view bytes, const std::string& name) {
  if (const std::string compression = foreign_compression(bytes); !compression.empty())
    refuse(name, fmt::format("must have chunks without compression or with zstd, and has some with {}",
                             compression.substr(0, 20)));
  Channels channels;
  const mcap::McapReport report = mcap::walk_mcap(bytes, channels);
  if (report.truncated)
    refuse(name,
           fmt::format("was cut off at byte {}: a trace must be whole, and `mcap recover` makes one of what is there",
                       bytes.size()));
  if (report.chunks_lost > 0)
    refuse(name, fmt::format("must be sound, and {} of {} are damaged", report.chunks_lost,
                             counted(report.chunks_lost + report.chunks_read, "chunk")));
  TraceMessages trace;
  std::uint16_t channel = channel_of(channels, kTruthSchema, name);
  if (channel == 0) {
    trace.type = MessageType::kSensorView;
    channel = channel_of(channels, kViewSchema, name);
  }
  if (channel == 0) {
    std::vector<std::string> others;
    for (const auto& [id, type] : channels.types)
      if (std::ranges::find(others, type) == others.end() && others.size() < 3) others.push_back(type);
    refuse(name, fmt::format("must have a channel of {} or {}, and has {}", kTruthSchema, kViewSchema,
                             others.empty() ? "no channel" : "channels of " + joined(others)));
  }
  trace.kept = std::move(channels.messages[channel]);
  trace.messages.assign(trace.kept.begin(), trace.kept.end());
  if (trace.messages.empty()) refuse(name, "must have a message, and is empty");
  return trace;
}

// `.osi`.

bool stamped(const osi3::Timestamp& stamp) { return stamp.has_seconds() || stamp.has_nanos(); }

bool makes_sense(const osi3::GroundTruth& truth) {
  return stamped(truth.timestamp()) && std::ranges::any_of(truth.moving_object(), [](const osi3::MovingObject& object) {
           return object.id().has_value() && object.base().position().has_x();
         });
}

enum class Sense { kNone, kGroundTruth, kSensorView, kSensorData };

Sense sense_of(std::string_view message) {
  const auto parse = [message](auto& out) {
    return message.size() <= INT32_MAX && out.ParsePartialFromArray(message.data(), static_cast<int>(message.size()));
  };
  osi3::GroundTruth truth;
  if (parse(truth) && makes_sense(truth)) return Sense::kGroundTruth;
  osi3::SensorView view;
  if (parse(view) && makes_sense(view.global_ground_truth())) return Sense::kSensorView;
  osi3::SensorData data;
  if (parse(data) && stamped(data.timestamp()) &&
      std::ranges::any_of(data.moving_object(), [](const osi3::DetectedMovingObject& object) {
        return object.header().tracking_id().has_value();
      }))
    return Sense::kSensorData;
  return Sense::kNone;
}

// Returns the messages; each has its length in front, in four bytes.
std::vector<std::string_view> messages_in(std::string_view bytes, const std::string& name) {
  std::vector<std::string_view> messages;
  for (std::size_t at = 0; at < bytes.size();) {
    const std::string_view rest = bytes.substr(at);
    std::uint32_t length = 0;
    if (rest.size() >= sizeof length) std::memcpy(&length, rest.data(), sizeof length);
    if (rest.size() < sizeof length || length > rest.size() - sizeof length) {
      if (messages.empty())
        refuse(name,
               fmt::format("must begin with the length of a message and the message itself: it is no OSI trace, or "
                           "was cut off at byte {}",
                           bytes.size()));
      refuse(name,
             fmt::format("was cut off within message {} at byte {}: a trace must be whole, and `head -c {}` leaves "
                         "the {} before it",
                         messages.size() + 1, at, at, messages.size()));
    }
    messages.push_back(rest.substr(sizeof length, length));
    at += sizeof length + length;
  }
  if (messages.empty()) refuse(name, "must have a message, and is empty");
  return messages;
}

TraceMessages from_osi(std::string_view bytes, const std::string& name) {
  TraceMessages trace;
  trace.guessed = true;
  trace.messages = messages_in(bytes, name);
  Sense sense = Sense::kNone;
  for (std::size_t m = 0; m < trace.messages.size() && sense == Sense::kNone; ++m) sense = sense_of(trace.messages[m]);
  switch (sense) {
    case Sense::kGroundTruth: trace.type = MessageType::kGroundTruth; break;
    case Sense::kSensorView: trace.type = MessageType::kSensorView; break;
    case Sense::kSensorData: refuse(name, "must be a trace of GroundTruth or SensorView, and is one of SensorData");
    case Sense::kNone:
      refuse(name,
             "must be a trace of GroundTruth or SensorView: in neither type does a message have a stamp and a moving "
             "object with id and position");
  }
  return trace;
}

}  // namespace

TraceMessages trace_messages(std::string_view bytes, const std::string& name) {
  return bytes.starts_with(mcap::kMcapMagic) ? from_mcap(bytes, name) : from_osi(bytes, name);
}

}  // namespace ttf::recording::osi
