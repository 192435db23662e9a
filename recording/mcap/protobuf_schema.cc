#include "recording/mcap/protobuf_schema.h"

#include <google/protobuf/descriptor.h>
#include <google/protobuf/descriptor.pb.h>

#include <set>

#include "core/check.h"

namespace ttf::recording::mcap {
namespace {

class SchemaOf {
 public:
  explicit SchemaOf(const google::protobuf::Descriptor& message) {
    need(message);
    add(*message.file());
  }
  const google::protobuf::FileDescriptorSet& files() const { return files_; }

 private:
  void need(const google::protobuf::Descriptor& type) {
    if (!needed_.insert(type.full_name()).second) return;
    needed_files_.insert(type.file()->name());
    for (int i = 0; i < type.field_count(); ++i)
      if (type.field(i)->message_type() != nullptr) need(*type.field(i)->message_type());
  }

  void add(const google::protobuf::FileDescriptor& file) {
    if (!added_.insert(file.name()).second) return;
    for (int i = 0; i < file.dependency_count(); ++i)
      if (needed_files_.count(file.dependency(i)->name()) != 0) add(*file.dependency(i));
    google::protobuf::FileDescriptorProto whole;
    file.CopyTo(&whole);
    google::protobuf::FileDescriptorProto& out = *files_.add_file();
    out.set_name(whole.name());
    out.set_package(whole.package());
    out.set_syntax(whole.syntax());
    for (const std::string& dependency : whole.dependency())
      if (needed_files_.count(dependency) != 0) out.add_dependency(dependency);
    for (int i = 0; i < file.message_type_count(); ++i)
      if (needed_.count(file.message_type(i)->full_name()) != 0) *out.add_message_type() = whole.message_type(i);
  }

  std::set<std::string> needed_, needed_files_, added_;
  google::protobuf::FileDescriptorSet files_;
};

}  // namespace

std::string protobuf_schema(const google::protobuf::Descriptor& message) {
  std::string bytes;
  TTF_CHECK(SchemaOf(message).files().SerializeToString(&bytes), "schema of {}", message.full_name());
  return bytes;
}

}  // namespace ttf::recording::mcap
