// A log loses no part of a record. Payloads are filled by reflection over the format, so that a field without
// encoder or decoder shows under any name. A record has as many fields as its payload.
#include <google/protobuf/util/message_differencer.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <cstdlib>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "recording/log/codec.h"
#include "recording/log/reader.h"
#include "recording/records/every.h"
#include "tests/recording/log/log_fixture.h"

namespace ttf::recording::log {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;

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
  Payloads payloads;
  int seen = 0;

  template <class Record> void each(const Record& record) {
    encoder_->on(record);
    ++seen;
  }

 private:
  std::unique_ptr<records::Sink> encoder_ = encoder(payloads, [](const Encoded&) {});
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
    Payloads filled;
    Message& payload = *filled.of(kind);
    Fill(3).fill(payload);
    std::vector<const FieldDescriptor*> set;
    payload.GetReflection()->ListFields(payload, &set);
    ASSERT_EQ(static_cast<int>(set.size()), payload.GetDescriptor()->field_count()) << "a field left at its default";
    Again again;
    Decoder decoder;
    ASSERT_TRUE(decoder.decode(kind, payload.SerializeAsString(), again)) << records::topic_of(kind);
    EXPECT_EQ(again.seen, 1);
    EXPECT_EQ(difference(payload, *again.payloads.of(kind)), "") << records::topic_of(kind);
  }
}

// The same through a file: read, written, and read again.
TEST(LogFields, EveryFieldOfEveryPayloadIsInTheLog) {
  for (std::size_t k = 1; k <= records::kKindCount; ++k) {
    const auto kind = static_cast<records::RecordKind>(k);
    Payloads filled;
    Message& payload = *filled.of(kind);
    Fill(2).fill(payload);
    const std::string log = log_of([&](records::Sink& sink) {
      Decoder decoder;
      ASSERT_TRUE(decoder.decode(kind, payload.SerializeAsString(), sink));
    });
    Again again;
    const LogInfo info = read_log_bytes(log, "memory", again);
    EXPECT_EQ(info.warning, "");
    EXPECT_EQ(again.seen, 1);
    EXPECT_EQ(difference(payload, *again.payloads.of(kind)), "") << records::topic_of(kind);
  }
}

// The number of fields of a struct: the most values it can be initialised from. Fewer may fail, as some types
// have no default.
struct Anything {
  template <class T> operator T() const { std::abort(); }  // never called
};
template <class T, std::size_t... I> constexpr bool takes(std::index_sequence<I...>) {
  return requires { T{(static_cast<void>(I), Anything{})...}; };
}
template <class T, std::size_t kMost = 30> constexpr int fields_of() {
  if constexpr (takes<T>(std::make_index_sequence<kMost>{}))
    return kMost;
  else
    return fields_of<T, kMost - 1>();
}

template <class Record, class Payload> void expect_same_fields(int apart = 0) {
  EXPECT_EQ(fields_of<Record>() + apart, Payload::descriptor()->field_count()) << Payload::descriptor()->full_name();
}

TEST(LogFields, ARecordHasAsManyFieldsAsItsPayload) {
  struct Three {
    int a;
    std::span<const double, 6> b;
    records::Stamp c;
  };
  ASSERT_EQ(fields_of<Three>(), 3);
  expect_same_fields<records::Stamp, ttfusion::Stamp>();
  expect_same_fields<MeasurementId, ttfusion::MeasurementId>();
  expect_same_fields<records::ImageObject, ttfusion::ImageObject>();
  records::for_each_kind([]<class Record>() {
    // The feature service's objects are parallel lists there: images and a list for each of their other
    // fields. The four numbers of a plan's region are fields there.
    const bool parallel = std::is_same_v<Record, records::FeatureUsed>;
    const bool region = std::is_same_v<Record, records::PlanMade>;
    expect_same_fields<Record, Payload<Record>>(parallel ? fields_of<records::FeatureObject>() - 1 : region ? 3 : 0);
  });
}

}  // namespace
}  // namespace ttf::recording::log
