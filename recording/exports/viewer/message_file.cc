#include "recording/exports/viewer/message_file.h"

#include <google/protobuf/descriptor.h>
#include <google/protobuf/message_lite.h>

#include <algorithm>
#include <filesystem>
#include <system_error>

#include "core/check.h"
#include "recording/mcap/protobuf_schema.h"
#include "recording/scene/instants.h"

namespace ttf::recording::exports::viewer {

// The profile keeps the program from taking the file for a log.
MessageFile::MessageFile(const std::string& path) : path_(path), mcap_(path, "x-ttfusion-scene", "ttfusion") {}

MessageFile::~MessageFile() {
  std::error_code none;
  if (!finished_ && std::filesystem::is_regular_file(path_, none)) std::filesystem::remove(path_, none);
}

std::uint16_t MessageFile::topic(const std::string& name, const google::protobuf::Descriptor& type) {
  const auto [schema, added] = schemas_.try_emplace(type.full_name(), static_cast<std::uint16_t>(schemas_.size() + 1));
  if (added) mcap_.add_schema(schema->second, type.full_name(), "protobuf", mcap::protobuf_schema(type));
  mcap_.add_channel(++channels_, schema->second, name, "protobuf");
  return channels_;
}

void MessageFile::add(std::uint16_t channel, TrueTime at, const google::protobuf::MessageLite& message) {
  Message& waiting = waiting_.emplace(scene::shown(at), Message{channel, {}})->second;
  TTF_CHECK(message.SerializeToString(&waiting.bytes), "{}", message.GetTypeName());
}

void MessageFile::write_before(TrueTime at) { write_until(waiting_.lower_bound(at)); }

void MessageFile::finish() {
  write_until(waiting_.end());
  mcap_.close();
  finished_ = true;
}

void MessageFile::write_until(std::multimap<TrueTime, Message>::iterator end) {
  for (auto one = waiting_.begin(); one != end; one = waiting_.erase(one)) {
    written_ = std::max(written_, one->first);
    const auto stamp = static_cast<std::uint64_t>(written_.ns);
    mcap_.add_message(one->second.channel, stamp, stamp, one->second.bytes);
  }
}

}  // namespace ttf::recording::exports::viewer
