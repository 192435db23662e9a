#include <bit>
#include <optional>
#include <type_traits>
#include <utility>

#include "recording/log/codec.h"
#include "recording/log/wire.h"
#include "recording/records/every.h"
#include "recording/records/fields.h"

namespace ttf::recording::log {
namespace {

// Writes fields as protobuf's own serializer does: in the order of their numbers, lists of numbers packed, and neither
// zeros nor empty texts and lists. Messages are always there.
class Encoding {
 public:
  explicit Encoding(WireWriter& out) : out_(out) {}

  template <class Described> void all(const Described& in) {
    records::for_each_field<Described>([&](const auto& entry) { write(in, entry); });
  }

 private:
  template <class Record, class Member, class Range>
  void write(const Record& in, const records::Field<Record, Member, Range>& field) {
    value(field.number, in.*field.member);
  }
  template <class Record> void write(const Record& in, const records::Optional<Record>& field) {
    out_.number(field.number, in.*field.member);
  }
  template <class Record, std::size_t count>
  void write(const Record& in, const records::Elements<Record, count>& elements) {
    for (std::uint32_t i = 0; i < count; ++i) value(elements.first + i, (in.*elements.member)[i]);
  }
  template <class Record, class Item, class... Columns>
  void write(const Record& in, const records::Columns<Record, Item, Columns...>& list) {
    list.columns.each([&](const auto& column) { write_column(in.*list.member, column); });
  }
  template <class Item, class Member, class Range>
  void write_column(std::span<const Item> items, const records::Field<Item, Member, Range>& column) {
    if constexpr (records::IsDescribed<Member>) {
      for (const Item& item : items) value(column.number, item.*column.member);
    } else if (!items.empty()) {
      out_.block(column.number, [&] {
        for (const Item& item : items) packed(item.*column.member);
      });
    }
  }

  template <class T> void value(std::uint32_t number, const T& in) {
    if constexpr (records::IsDescribed<T>) {
      out_.block(number, [&] { all(in); });
    } else if constexpr (std::is_same_v<T, double>) {
      if (std::bit_cast<std::uint64_t>(in) != 0) out_.number(number, in);  // -0.0 is written
    } else if constexpr (requires { varint_of(in); }) {
      if (const std::uint64_t bits = varint_of(in); bits != 0) out_.number(number, bits);
    } else {
      list(number, in);
    }
  }
  void list(std::uint32_t number, const std::optional<records::BelievedBox>& in) {
    if (in) out_.block(number, &*in, sizeof *in);
  }
  template <class List> void list(std::uint32_t number, const List& in) {
    using Item = std::remove_const_t<std::remove_pointer_t<decltype(in.data())>>;
    if constexpr (records::IsDescribed<Item>) {
      for (const Item& item : in) value(number, item);
    } else if constexpr (std::is_same_v<Item, double> || sizeof(Item) == 1) {
      if (!in.empty()) out_.block(number, in.data(), in.size() * sizeof(Item));
    } else if (!in.empty()) {
      out_.block(number, [&] {
        for (const Item& item : in) packed(item);
      });
    }
  }
  template <class T> void packed(const T& in) {
    if constexpr (std::is_same_v<T, double>)
      out_.raw(&in, sizeof in);
    else
      out_.varint(varint_of(in));
  }

  WireWriter& out_;
};

template <class Record> LogTimes times_of(const Record& in) {
  constexpr auto instant = records::kDescription<Record>.instant;
  if constexpr (requires { in.*instant; }) {
    const records::Stamp& stamp = in.*instant;
    return {stamp.true_time.ns, stamp.global.ns};
  } else {
    const std::int64_t at = (in.*instant.true_time).ns;
    if constexpr (instant.global != nullptr)
      return {at, (in.*instant.global).ns};
    else
      return {at, at};
  }
}

class Encoder final : public records::Every<Encoder> {
 public:
  explicit Encoder(std::function<void(const Encoded&)> out) : out_(std::move(out)) {}

  template <class Record> void each(const Record& record) {
    payload_.clear();
    Encoding(payload_).all(record);
    out_({records::kKindOf<Record>, payload_.bytes(), times_of(record)});
  }

 private:
  WireWriter payload_;
  std::function<void(const Encoded&)> out_;
};

}  // namespace

std::unique_ptr<records::Sink> encoder(std::function<void(const Encoded&)> out) {
  return std::make_unique<Encoder>(std::move(out));
}

}  // namespace ttf::recording::log
