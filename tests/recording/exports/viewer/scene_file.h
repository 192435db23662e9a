// A file for viewers as they read it: topics, and messages by the schemas in the file. Problems of the file as a file are
// listed.
#pragma once

#include <fmt/format.h>
#include <google/protobuf/descriptor.h>
#include <google/protobuf/descriptor.pb.h>
#include <google/protobuf/dynamic_message.h>

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "recording/exports/viewer/foxglove.pb.h"
#include "recording/mcap/bytes.h"
#include "recording/mcap/chunk.h"
#include "recording/mcap/reader.h"

namespace ttf::recording::exports::viewer {

class SceneFile final : mcap::McapHandler {
 public:
  struct Message {
    std::string topic;
    std::uint64_t at = 0;
    std::string bytes;
  };
  std::vector<Message> messages;              // in file order
  std::map<std::string, std::string> topics;  // to the names of their types
  std::vector<std::string> problems;

  explicit SceneFile(std::string_view bytes) {
    std::size_t at = mcap::kMcapMagic.size();
    while (true) {
      const auto record = mcap::record_at(bytes, at);
      if (!record) break;
      declare(*record);
      at += mcap::kRecordHead + record->content.size();
    }
    const mcap::McapReport report = mcap::walk_mcap(bytes, *this);
    problems.insert(problems.end(), report.warnings.begin(), report.warnings.end());
    if (report.truncated) problems.push_back("is truncated");
    if (mcap::mcap_profile(bytes) != "x-ttfusion-scene") problems.push_back("has another profile");
  }

  // The messages of a topic, by our own code.
  template <class Type = ::foxglove::SceneUpdate>
  std::vector<std::pair<std::uint64_t, Type>> of(const std::string& topic) const {
    std::vector<std::pair<std::uint64_t, Type>> found;
    for (const Message& message : messages)
      if (message.topic == topic) found.emplace_back(message.at, Type{}).second.ParseFromString(message.bytes);
    return found;
  }
  // A schema of the file; null if it is not there, or not whole.
  const google::protobuf::Descriptor* type(const std::string& name) const {
    const auto found = pools_.find(name);
    return found == pools_.end() ? nullptr : found->second->FindMessageTypeByName(name);
  }

 private:
  void declare(const mcap::McapRecord& record) {
    mcap::FieldReader fields(record.content);
    const auto id = fields.take<std::uint16_t>();
    if (record.opcode == static_cast<std::uint8_t>(mcap::Opcode::kSchema)) {
      const std::string name(fields.text());
      if (fields.text() != "protobuf") problems.push_back(name + " is no protobuf");
      const std::string_view data = fields.text();
      google::protobuf::FileDescriptorSet set;
      if (!set.ParseFromArray(data.data(), static_cast<int>(data.size()))) problems.push_back(name + " has no schema");
      auto& pool = pools_[name] = std::make_unique<google::protobuf::DescriptorPool>();
      for (const auto& file : set.file())
        if (pool->BuildFile(file) == nullptr) problems.push_back(name + " needs more than " + file.name());
      if (type(name) == nullptr) problems.push_back(name + " is not in its schema");
      schemas_[id] = name;
    } else if (record.opcode == static_cast<std::uint8_t>(mcap::Opcode::kChannel)) {
      const auto schema = fields.take<std::uint16_t>();
      const std::string topic(fields.text());
      channels_[id] = topic;
      topics[topic] = schemas_[schema];
    }
  }

  void on_metadata(std::string_view, const std::vector<std::pair<std::string, std::string>>&) override {}
  void on_attachment(std::string_view, std::string_view, std::string_view) override {}
  bool on_message(std::uint16_t channel, std::uint64_t at, std::string_view payload) override {
    if (!messages.empty() && at < messages.back().at)
      problems.push_back(fmt::format("{} comes after {}", at, messages.back().at));
    messages.push_back({channels_[channel], at, std::string(payload)});
    const google::protobuf::Descriptor* schema = type(topics[channels_[channel]]);
    if (schema == nullptr) {
      problems.push_back(fmt::format("channel {} has no schema", channel));
      return true;
    }
    const std::unique_ptr<google::protobuf::Message> read(factory_.GetPrototype(schema)->New());
    if (!read->ParseFromString(messages.back().bytes) || !no_unknown(*read))
      problems.push_back(fmt::format("a message of {} is none by its schema", channels_[channel]));
    return true;
  }

  static bool no_unknown(const google::protobuf::Message& message) {
    const google::protobuf::Reflection& reflection = *message.GetReflection();
    if (!reflection.GetUnknownFields(message).empty()) return false;
    std::vector<const google::protobuf::FieldDescriptor*> fields;
    reflection.ListFields(message, &fields);
    for (const auto* field : fields) {
      if (field->cpp_type() != google::protobuf::FieldDescriptor::CPPTYPE_MESSAGE) continue;
      if (!field->is_repeated() && !no_unknown(reflection.GetMessage(message, field))) return false;
      for (int i = 0; field->is_repeated() && i < reflection.FieldSize(message, field); ++i)
        if (!no_unknown(reflection.GetRepeatedMessage(message, field, i))) return false;
    }
    return true;
  }

  std::map<std::string, std::unique_ptr<google::protobuf::DescriptorPool>> pools_;  // by name of the type
  google::protobuf::DynamicMessageFactory factory_;  // after the pools, so that it ends before them
  std::map<std::uint16_t, std::string> schemas_, channels_;
};

}  // namespace ttf::recording::exports::viewer
