// The schema of a protobuf message, as MCAP files have it.
#pragma once

#include <string>

namespace google::protobuf {
class Descriptor;
}  // namespace google::protobuf

namespace ttf::recording::mcap {

// Returns a FileDescriptorSet with the message and all messages it refers to, by files in the order of their dependence. A
// file's messages keep their order. The files may have no enumerations outside of messages.
std::string protobuf_schema(const google::protobuf::Descriptor& message);

}  // namespace ttf::recording::mcap
