// An MCAP file of protobuf messages for viewers. Messages come roughly in the order of time, and are written in exactly that
// order. Messages with the same time keep the order in which they came.
//
// A message's stamp is nanoseconds since the start of the drive. A message that comes after its time was written has the
// stamp of the last one before it. The same messages give the same bytes.
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "core/time.h"
#include "recording/mcap/writer.h"

namespace google::protobuf {
class Descriptor;
class MessageLite;
}  // namespace google::protobuf

namespace ttf::recording::exports::viewer {

class MessageFile {
 public:
  // Throws std::runtime_error if the file cannot be created.
  explicit MessageFile(const std::string& path);
  ~MessageFile();  // removes an unfinished file
  MessageFile(const MessageFile&) = delete;
  MessageFile& operator=(const MessageFile&) = delete;

  // Declares a topic and returns its channel; all topics come before the first message.
  std::uint16_t topic(const std::string& name, const google::protobuf::Descriptor& type);
  void add(std::uint16_t channel, TrueTime at, const google::protobuf::MessageLite& message);
  void write_before(TrueTime at);
  void finish();  // throws std::runtime_error if a write failed

 private:
  struct Message {
    std::uint16_t channel = 0;
    std::string bytes;
  };
  void write_until(std::multimap<TrueTime, Message>::iterator end);

  std::string path_;
  mcap::McapWriter mcap_;
  bool finished_ = false;
  std::map<std::string, std::uint16_t> schemas_;  // by name of the type
  std::uint16_t channels_ = 0;
  std::multimap<TrueTime, Message> waiting_;
  TrueTime written_{};  // the last stamp
};

}  // namespace ttf::recording::exports::viewer
