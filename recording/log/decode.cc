#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <type_traits>
#include <utility>
#include <vector>

#include "core/utf8.h"
#include "recording/log/codec.h"
#include "recording/log/wire.h"
#include "recording/records/fields.h"

namespace ttf::recording::log {
namespace detail {

struct Nothing {};
// A field's member only views its list, which stands in this storage.
template <class Member> struct StorageOf : std::type_identity<Nothing> {};
template <class Item, std::size_t extent>
struct StorageOf<std::span<const Item, extent>> : std::type_identity<std::vector<Item>> {};
template <> struct StorageOf<std::span<const std::byte>> : std::type_identity<Nothing> {};
template <> struct StorageOf<std::optional<records::BelievedBox>> : std::type_identity<std::vector<double>> {};

template <class Record, class Member, class Range>
typename StorageOf<Member>::type storage_for(const records::Field<Record, Member, Range>&);
template <class Record> Nothing storage_for(const records::Optional<Record>&);
template <class Record, std::size_t count> Nothing storage_for(const records::Elements<Record, count>&);
template <class Item, std::size_t columns> struct ColumnItems {
  std::vector<Item> items;
  std::array<std::size_t, columns> sizes;  // by column
};
template <class Record, class Item, class... Fields>
ColumnItems<Item, sizeof...(Fields)> storage_for(const records::Columns<Record, Item, Fields...>&);

template <class Places, class... Listed>
records::Entries<decltype(storage_for(std::declval<Listed>()))...> storage(records::EntriesAt<Places, Listed...>);
template <class Described>
using Storage = decltype(storage(std::declval<decltype(records::kDescription<Described>.fields)>()));

template <class Places> struct OfKinds;
template <std::size_t... i>
struct OfKinds<std::index_sequence<i...>> : records::Placed<i, Storage<records::RecordAt<i + 1>>>... {};

// Converts to every type. It is only named, so it has no definition.
struct Anything {
  template <class T> operator T() const;
};

}  // namespace detail

namespace {

using detail::Anything;
using detail::Nothing;
using detail::Storage;

template <class T, std::size_t... i> constexpr bool takes(std::index_sequence<i...>) {
  return requires { T{(static_cast<void>(i), Anything{})...}; };
}
template <class T, std::size_t count> constexpr bool kTakes = takes<T>(std::make_index_sequence<count>{});

// The number of a struct's members: the most values that can initialise it. Fewer may fail, as some types have no
// default.
template <class T, std::size_t most = 30> constexpr std::size_t members_of() {
  if constexpr (kTakes<T, most>)
    return most;
  else
    return members_of<T, most - 1>();
}
// Whether a struct has so many members. If it can be initialised with no value, it can be with any number up to theirs.
template <class T, std::size_t count> constexpr bool has_members() {
  if constexpr (kTakes<T, 0>)
    return kTakes<T, count> && !kTakes<T, count + 1>;
  else
    return members_of<T>() == count;
}

template <class Described> Described empty() { return {}; }
template <> records::TrackState empty() {
  static constexpr std::array<double, 36> kNothing{};
  return {.stamp = {}, .state = std::span(kNothing).first<6>(), .covariance = std::span(kNothing)};
}

// Reads the fields of one record, or of a part of it, and remembers whether all of them fitted.
template <class Described> class Decoding {
 public:
  static_assert(has_members<Described, Storage<Described>::kCount>(), "a member without a field");

  Decoding(Described& out, Storage<Described>& lists) : out_(out), lists_(lists) {}

  // An absent field is zero or empty, whatever the record's default.
  void clear() {
    each([&](const auto& entry, auto& list) { clear(entry, list); });
  }
  // As in protobuf, the last of several numbers counts, and parts of a message are merged.
  bool read(std::string_view bytes) {
    WireReader in(bytes);
    std::uint32_t misfits = 0;
    while (in.more()) {
      const std::uint32_t tag = in.tag();
      bool taken = false;
      std::uint32_t bit = 1;
      each([&]<class List>(const auto& entry, List& list) {
        if (!taken) {
          fits_ = true;
          taken = take(entry, list, tag, in);
          if (!std::is_same_v<List, Nothing>)
            must(fits_);
          else if (taken)
            misfits = fits_ ? misfits & ~bit : misfits | bit;
        }
        bit <<= 1;
      });
      if (!taken) in.skip(tag);
    }
    must(in.ok());
    sound_ = ok_;
    must(misfits == 0);
    each([&](const auto& entry, auto& list) { end(entry, list); });
    return ok_;
  }
  // Whether protobuf could read it, too.
  bool sound() const { return sound_; }

 private:
  template <class F> void each(F&& f) { records::kDescription<Described>.fields.each_with(lists_, f); }
  void must(bool holds) { ok_ = ok_ && holds; }

  template <class Member, class Range, class List>
  void clear(const records::Field<Described, Member, Range>& field, List& list) {
    if constexpr (!std::is_same_v<List, Nothing>)
      list.clear();
    else
      out_.*field.member = Member{};
  }
  void clear(const records::Optional<Described>& field, Nothing) {
    out_.*field.member = std::numeric_limits<double>::quiet_NaN();
  }
  template <std::size_t count> void clear(const records::Elements<Described, count>& elements, Nothing) {
    out_.*elements.member = {};
  }
  template <class Item, class... Columns, class List>
  void clear(const records::Columns<Described, Item, Columns...>&, List& list) {
    list.items.clear();
    list.sizes = {};
  }

  // Each returns whether the field was of the entry.
  template <class Member, class Range, class List>
  bool take(const records::Field<Described, Member, Range>& field, List& list, std::uint32_t tag, WireReader& in) {
    if (tag >> 3 != field.number) return false;
    if constexpr (std::is_same_v<List, Nothing>)
      return one(out_.*field.member, tag, in);
    else
      return items<typename List::value_type>(tag, in, [&](const auto& item) { list.push_back(item); });
  }
  bool take(const records::Optional<Described>& field, Nothing, std::uint32_t tag, WireReader& in) {
    return tag >> 3 == field.number && one(out_.*field.member, tag, in);
  }
  template <std::size_t count>
  bool take(const records::Elements<Described, count>& elements, Nothing, std::uint32_t tag, WireReader& in) {
    const std::uint32_t at = (tag >> 3) - elements.first;
    return at < count && one((out_.*elements.member)[at], tag, in);
  }
  template <class Item, class... Columns, class List>
  bool take(const records::Columns<Described, Item, Columns...>& all, List& list, std::uint32_t tag, WireReader& in) {
    std::size_t at = 0;
    bool taken = false;
    all.columns.each([&](const auto& column) { taken = taken || take_column(column, list, at, tag, in), ++at; });
    return taken;
  }
  template <class Item, class Member, class Range, class List>
  bool take_column(const records::Field<Item, Member, Range>& column, List& list, std::size_t at, std::uint32_t tag,
                   WireReader& in) {
    return tag >> 3 == column.number && items<Member>(tag, in, [&](const Member& cell) {
             const std::size_t row = list.sizes[at]++;
             if (row == list.items.size()) list.items.emplace_back();
             list.items[row].*column.member = cell;
           });
  }

  // Reads one value, if the field is of its type on the wire.
  template <class T> bool one(T& value, std::uint32_t tag, WireReader& in) {
    const auto type = static_cast<WireType>(tag & 7);
    if constexpr (IsVarint<T>) {
      if (type != WireType::kVarint) return false;
      if (!from_varint(in.varint(), value)) fits_ = false;
    } else if constexpr (std::is_same_v<T, double>) {
      if (type != WireType::kFixed64) return false;
      value = in.take<double>();
    } else {
      if (type != WireType::kBlock) return false;
      const std::string_view bytes = in.block();
      if constexpr (records::IsDescribed<T>) {
        Storage<T> none;
        Decoding<T> part(value, none);
        if (!part.read(bytes)) fits_ = false;
        must(part.sound());
      } else if constexpr (std::is_same_v<T, std::string_view>) {
        must(is_utf8(bytes));
        value = bytes;
      } else {
        value = std::as_bytes(std::span(bytes));
      }
    }
    return true;
  }
  // Reads the items of a list, packed or one by one.
  template <class Item, class Add> bool items(std::uint32_t tag, WireReader& in, Add&& add) {
    Item item{};
    if constexpr (!records::IsDescribed<Item>) {
      if (static_cast<WireType>(tag & 7) == WireType::kBlock) {
        WireReader packed(in.block());
        const auto type = std::is_same_v<Item, double> ? WireType::kFixed64 : WireType::kVarint;
        while (packed.more()) {
          one(item, static_cast<std::uint32_t>(type), packed);
          if (packed.ok()) add(item);
        }
        must(packed.ok());
        return true;
      }
    }
    if (!one(item, tag, in)) return false;
    if (in.ok()) add(item);
    return true;
  }

  template <class Member, class Range, class List>
  void end(const records::Field<Described, Member, Range>& field, List& list) {
    Member& member = out_.*field.member;
    if constexpr (std::is_same_v<Member, std::optional<records::BelievedBox>>) {
      constexpr std::size_t kNumbers = sizeof(records::BelievedBox) / sizeof(double);
      must(list.empty() || list.size() == kNumbers);
      if (list.size() != kNumbers) return void(member = std::nullopt);
      std::array<double, kNumbers> numbers;
      std::copy_n(list.begin(), kNumbers, numbers.begin());
      member = std::bit_cast<records::BelievedBox>(numbers);
    } else if constexpr (requires {
                           Member::extent;
                           list.size();
                         }) {
      constexpr bool kAnySize = Member::extent == std::dynamic_extent;
      must(kAnySize || list.size() == Member::extent);
      if (kAnySize || list.size() == Member::extent) member = Member(list.data(), list.size());
      if constexpr (!std::is_same_v<Range, records::AnyValue>)
        must(list.size() >= field.range.low && list.size() <= field.range.high);
    } else if constexpr (!std::is_same_v<Range, records::AnyValue>) {
      must(member >= field.range.low && member <= field.range.high);
    }
  }
  void end(const records::Optional<Described>&, Nothing) {}
  template <std::size_t count> void end(const records::Elements<Described, count>&, Nothing) {}
  template <class Item, class... Columns, class List>
  void end(const records::Columns<Described, Item, Columns...>& all, List& list) {
    for (const std::size_t size : list.sizes) must(size == list.items.size());
    out_.*all.member = list.items;
  }

  Described& out_;
  Storage<Described>& lists_;
  bool ok_ = true, fits_ = true, sound_ = true;
};

}  // namespace

struct Decoder::Lists {
  detail::OfKinds<std::make_index_sequence<records::kKindCount>> of_kind;
};

Decoder::Decoder() : lists_(std::make_unique<Lists>()) {}
Decoder::~Decoder() = default;

bool Decoder::decode(records::RecordKind kind, std::string_view bytes, records::Sink& sink) {
  bool decoded = false;
  records::for_kind(kind, [&]<class Record>() {
    Record record = empty<Record>();
    constexpr std::size_t kPlace = records::number_of(records::kKindOf<Record>) - 1;
    Decoding<Record> fields(record,
                            static_cast<records::Placed<kPlace, detail::Storage<Record>>&>(lists_->of_kind).entry);
    fields.clear();
    decoded = fields.read(bytes);
    if (decoded) sink.on(record);
  });
  return decoded;
}

}  // namespace ttf::recording::log
