// A log loses no part of a record, and is what the published schema says. Protobuf's own code, generated from the schema,
// fills payloads, and reads and writes those of the encoder.
#include <google/protobuf/message.h>
#include <google/protobuf/stubs/logging.h>
#include <google/protobuf/util/message_differencer.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "core/random.h"
#include "recording/log/codec.h"
#include "recording/log/log.pb.h"
#include "recording/log/reader.h"
#include "recording/records/every.h"
#include "recording/records/fields.h"
#include "tests/recording/log/log_fixture.h"

namespace ttf::recording::log {
namespace {

using google::protobuf::Descriptor;
using google::protobuf::FieldDescriptor;
using google::protobuf::Message;

template <class Described> const Descriptor* schema_of() {
  return ttfusion::Stamp::descriptor()->file()->FindMessageTypeByName(
      std::string(records::kDescription<Described>.message));
}
std::unique_ptr<Message> message_of(records::RecordKind kind) {
  std::unique_ptr<Message> message;
  records::for_kind(kind, [&]<class Record>() {
    message.reset(google::protobuf::MessageFactory::generated_factory()->GetPrototype(schema_of<Record>())->New());
  });
  return message;
}

// Sets every field of a payload to its own non-default value. Numbers count from 1, so that they fit the
// smallest types; truth values are all true. Lists get `list` items, those of fixed size their own number.
class Fill {
 public:
  explicit Fill(int list) : list_(list) {}

  void fill(Message& message) {
    const auto* descriptor = message.GetDescriptor();
    for (int f = 0; f < descriptor->field_count(); ++f) {
      const FieldDescriptor& field = *descriptor->field(f);
      const int items = field.full_name() == "ttfusion.Track.state"        ? 6
                        : field.full_name() == "ttfusion.Track.box"        ? 10
                        : field.full_name() == "ttfusion.Track.covariance" ? 36
                                                                           : list_;
      for (int i = 0; i < (field.is_repeated() ? items : 1); ++i) set(message, field);
    }
  }

 private:
  // Small choices are dispositions, hops, symbols, signals, a fault's act, a CAN's error, a timing problem's and a
  // histogram's subject. An object's status has four bits. A guardian and a timing problem have one of two
  // channels. The states of a CAN controller count from 0 and differ. All other fields take the next number.
  std::uint32_t whole(const FieldDescriptor& field) {
    if (field.full_name() == "ttfusion.Guardian.channel" || field.full_name() == "ttfusion.TimingProblem.channel")
      return 1;
    if (field.full_name() == "ttfusion.CanState.from") return 1;
    if (field.full_name() == "ttfusion.CanState.to") return 2;
    const bool small =
        field.name() == "disposition" || field.name() == "hop" || field.full_name() == "ttfusion.ImageObject.status" ||
        field.full_name() == "ttfusion.Symbol.kind" || field.full_name() == "ttfusion.Guardian.signal" ||
        field.full_name() == "ttfusion.Fault.what" || field.full_name() == "ttfusion.TimingProblem.what" ||
        field.full_name() == "ttfusion.Lateness.of" || field.full_name() == "ttfusion.CanError.error";
    return small ? 3 : ++next_;
  }
  void set(Message& message, const FieldDescriptor& field) {
    const auto& reflection = *message.GetReflection();
    const bool many = field.is_repeated();
    switch (field.cpp_type()) {
      case FieldDescriptor::CPPTYPE_UINT32: {
        const std::uint32_t value = whole(field);
        many ? reflection.AddUInt32(&message, &field, value) : reflection.SetUInt32(&message, &field, value);
        break;
      }
      case FieldDescriptor::CPPTYPE_INT32:
        reflection.SetInt32(&message, &field, static_cast<std::int32_t>(++next_));
        break;
      case FieldDescriptor::CPPTYPE_UINT64:
        many ? reflection.AddUInt64(&message, &field, ++next_) : reflection.SetUInt64(&message, &field, ++next_);
        break;
      case FieldDescriptor::CPPTYPE_INT64: reflection.SetInt64(&message, &field, ++next_); break;
      case FieldDescriptor::CPPTYPE_DOUBLE:
        many ? reflection.AddDouble(&message, &field, ++next_) : reflection.SetDouble(&message, &field, ++next_);
        break;
      case FieldDescriptor::CPPTYPE_BOOL:
        many ? reflection.AddBool(&message, &field, true) : reflection.SetBool(&message, &field, true);
        break;
      case FieldDescriptor::CPPTYPE_STRING:
        reflection.SetString(&message, &field, std::string(1, static_cast<char>(++next_)));
        break;
      case FieldDescriptor::CPPTYPE_MESSAGE:
        fill(many ? *reflection.AddMessage(&message, &field) : *reflection.MutableMessage(&message, &field));
        break;
      default: FAIL() << field.full_name() << " is of a type this test does not know";
    }
  }

  int list_;
  std::uint32_t next_ = 0;
};

// Encodes every record again.
class Again final : public records::Every<Again> {
 public:
  std::string payload;
  int seen = 0;

  template <class Record> void each(const Record& record) {
    encoder_->on(record);
    ++seen;
  }

 private:
  std::unique_ptr<records::Sink> encoder_ = encoder([this](const Encoded& encoded) { payload = encoded.payload; });
};

std::string difference(const Message& expected, const Message& found) {
  std::string text;
  google::protobuf::util::MessageDifferencer differencer;
  differencer.ReportDifferencesToString(&text);
  return differencer.Compare(expected, found) ? "" : text;
}

TEST(LogFields, EveryFieldOfEveryPayloadIsDecodedAndEncoded) {
  for (std::size_t k = 1; k <= records::kKindCount; ++k) {
    const auto kind = static_cast<records::RecordKind>(k);
    const auto payload = message_of(kind);
    Fill(3).fill(*payload);
    std::vector<const FieldDescriptor*> set;
    payload->GetReflection()->ListFields(*payload, &set);
    ASSERT_EQ(static_cast<int>(set.size()), payload->GetDescriptor()->field_count()) << "a field left at its default";
    Again again;
    Decoder decoder;
    ASSERT_TRUE(decoder.decode(kind, payload->SerializeAsString(), again)) << records::topic_of(kind);
    EXPECT_EQ(again.seen, 1);
    EXPECT_EQ(again.payload, payload->SerializeAsString()) << records::topic_of(kind);
  }
}

// The same through a file: read, written, and read again.
TEST(LogFields, EveryFieldOfEveryPayloadIsInTheLog) {
  for (std::size_t k = 1; k <= records::kKindCount; ++k) {
    const auto kind = static_cast<records::RecordKind>(k);
    const auto payload = message_of(kind);
    Fill(2).fill(*payload);
    const std::string log = log_of([&](records::Sink& sink) {
      Decoder decoder;
      ASSERT_TRUE(decoder.decode(kind, payload->SerializeAsString(), sink));
    });
    Again again;
    const LogInfo info = read_log_bytes(log, "memory", again);
    EXPECT_EQ(info.warning, "");
    EXPECT_EQ(again.seen, 1);
    const auto found = message_of(kind);
    ASSERT_TRUE(found->ParseFromString(again.payload));
    EXPECT_EQ(difference(*payload, *found), "") << records::topic_of(kind);
  }
}

// The encoder's bytes are those that protobuf writes, with any values.
TEST(LogFields, PayloadsAreTheBytesThatProtobufWrites) {
  for (int k = 1; k <= static_cast<int>(records::kKindCount); ++k)
    for (const Values values : {Values::kZero, Values::kSmallest, Values::kLargest, Values::kDrawn})
      for (std::uint32_t i = 0; i < 20; ++i) {
        Again again;
        emit(again, k, values, i, 1'000'000 * i);
        const auto message = message_of(static_cast<records::RecordKind>(k));
        ASSERT_TRUE(message->ParseFromString(again.payload)) << k;
        EXPECT_EQ(message->SerializeAsString(), again.payload) << k;
      }
}

// The decoder refuses each changed payload that protobuf refuses. From another one it reads the same record as from the
// payload that protobuf writes of it.
TEST(LogFields, ChangedPayloadsAreReadAsProtobufReadsThem) {
  const google::protobuf::LogSilencer silencer;  // it reports each text that is no UTF-8
  int read = 0, refused = 0;
  for (std::uint32_t seed = 0; seed < 20'000; ++seed) {
    RandomStream stream({.seed = seed, .purpose = Purpose::kTest, .entity = 3});
    const int k = static_cast<int>(stream.integer(1, static_cast<std::int64_t>(records::kKindCount)));
    const auto kind = static_cast<records::RecordKind>(k);
    Again again;
    emit(again, k, Values::kDrawn, seed, 1'000);
    std::string bytes = again.payload;
    for (std::int64_t changes = stream.integer(1, 3); changes > 0 && !bytes.empty(); --changes) {
      const auto at = static_cast<std::size_t>(stream.integer(0, static_cast<std::int64_t>(bytes.size()) - 1));
      switch (stream.integer(0, 3)) {
        case 0: bytes[at] = static_cast<char>(stream.integer(0, 255)); break;
        case 1: bytes.erase(at, static_cast<std::size_t>(stream.integer(1, 5))); break;
        case 2: bytes.insert(at, 1, static_cast<char>(stream.integer(0, 127))); break;
        default: bytes += again.payload.substr(at % again.payload.size());
      }
    }
    const auto message = message_of(kind);
    Again changed, rewritten;
    Decoder decoder;
    const bool ours = decoder.decode(kind, bytes, changed);
    if (!message->ParseFromString(bytes)) {
      EXPECT_FALSE(ours) << seed;
      ++refused;
      continue;
    }
    message->DiscardUnknownFields();
    ASSERT_EQ(decoder.decode(kind, message->SerializeAsString(), rewritten), ours) << seed << ' ' << k;
    if (!ours) continue;
    EXPECT_EQ(changed.payload, rewritten.payload) << seed << ' ' << k;
    ++read;
  }
  EXPECT_GT(read, 2000);
  EXPECT_GT(refused, 2000);
}

// The type that protobuf has for a member.
template <class Member> FieldDescriptor::Type type_of() {
  if constexpr (records::IsDescribed<Member>)
    return FieldDescriptor::TYPE_MESSAGE;
  else if constexpr (std::is_same_v<Member, bool>)
    return FieldDescriptor::TYPE_BOOL;
  else if constexpr (std::is_same_v<Member, double> || std::is_same_v<Member, std::optional<records::BelievedBox>>)
    return FieldDescriptor::TYPE_DOUBLE;
  else if constexpr (std::is_same_v<Member, std::string_view>)
    return FieldDescriptor::TYPE_STRING;
  else if constexpr (std::is_same_v<Member, std::span<const std::byte>>)
    return FieldDescriptor::TYPE_BYTES;
  else if constexpr (requires { typename Member::element_type; })
    return type_of<typename Member::value_type>();
  else if constexpr (std::is_same_v<Member, std::uint64_t>)
    return FieldDescriptor::TYPE_UINT64;
  else if constexpr (std::is_enum_v<Member> || std::is_unsigned_v<Member>)
    return FieldDescriptor::TYPE_UINT32;
  else if constexpr (std::is_integral_v<Member> && sizeof(Member) < 8)
    return FieldDescriptor::TYPE_SINT32;
  else
    return FieldDescriptor::TYPE_SINT64;
}
template <class Member> constexpr bool kIsList = requires { typename Member::element_type; }
&&!std::is_same_v<Member, std::span<const std::byte>>;

// Compares descriptions with the schema.
class Schema {
 public:
  explicit Schema(const Descriptor& message) : message_(message) {}

  template <class Record, class Member, class Range>
  void operator()(const records::Field<Record, Member, Range>& field) {
    one<Member>(field.number, field.name,
                kIsList<Member> || std::is_same_v<Member, std::optional<records::BelievedBox>>);
  }
  template <class Record> void operator()(const records::Optional<Record>& field) {
    one<double>(field.number, field.name, false);
    EXPECT_TRUE(message_.FindFieldByNumber(static_cast<int>(field.number))->has_optional_keyword());
  }
  template <class Record, std::size_t count> void operator()(const records::Elements<Record, count>& elements) {
    for (std::uint32_t i = 0; i < count; ++i) one<double>(elements.first + i, elements.names[i], false);
  }
  template <class Record, class Item, class... Fields>
  void operator()(const records::Columns<Record, Item, Fields...>& list) {
    const auto column = [&]<class Member, class Range>(const records::Field<Item, Member, Range>& field) {
      one<Member>(field.number, field.name, true);
    };
    list.columns.each(column);
  }
  int fields() const { return fields_; }

 private:
  template <class Member> void one(std::uint32_t number, std::string_view name, bool repeated) {
    EXPECT_GT(number, last_) << name << ": fields are written in the order of their numbers";
    last_ = number;
    ++fields_;
    const FieldDescriptor* const field = message_.FindFieldByNumber(static_cast<int>(number));
    ASSERT_NE(field, nullptr) << message_.full_name() << ' ' << number;
    EXPECT_EQ(field->name(), name);
    EXPECT_EQ(field->type(), type_of<Member>()) << field->full_name();
    EXPECT_EQ(field->is_repeated(), repeated) << field->full_name();
    if constexpr (kIsList<Member>)
      message<typename Member::value_type>(*field);
    else
      message<Member>(*field);
  }
  template <class Item> void message(const FieldDescriptor& field) {
    if constexpr (records::IsDescribed<Item>) {
      EXPECT_EQ(field.message_type(), schema_of<Item>()) << field.full_name();
    }
  }

  const Descriptor& message_;
  std::uint32_t last_ = 0;
  int fields_ = 0;
};

template <class Described> void expect_as_in_schema() {
  const Descriptor* const message = schema_of<Described>();
  ASSERT_NE(message, nullptr) << records::kDescription<Described>.message;
  Schema schema(*message);
  records::for_each_field<Described>(schema);
  EXPECT_EQ(schema.fields(), message->field_count()) << message->full_name();
}

TEST(LogFields, TheDescriptionsAreThoseOfTheSchema) {
  expect_as_in_schema<records::Stamp>();
  expect_as_in_schema<MeasurementId>();
  expect_as_in_schema<records::ImageObject>();
  records::for_each_kind([]<class Record>() { expect_as_in_schema<Record>(); });
  EXPECT_EQ(ttfusion::Stamp::descriptor()->file()->message_type_count(), 3 + static_cast<int>(records::kKindCount));
}

}  // namespace
}  // namespace ttf::recording::log
