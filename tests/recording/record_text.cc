#include "tests/recording/record_text.h"

#include <fmt/format.h>

#include <array>
#include <bit>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <type_traits>

#include "core/check.h"
#include "core/random.h"
#include "recording/records/fields.h"
#include "recording/records/kinds.h"

namespace ttf::recording {
namespace {

using BoxNumbers = std::array<double, sizeof(records::BelievedBox) / sizeof(double)>;

// Writes fields one after the other; doubles by their bits.
class Line {
 public:
  explicit Line(std::string name) : text_(std::move(name)) {}

  template <class T> Line& add(const T& value) {
    if constexpr (std::is_same_v<T, double>)
      text_ += fmt::format(" {:016x}", std::bit_cast<std::uint64_t>(value));
    else if constexpr (std::is_same_v<T, std::string_view>)
      text_ += fmt::format(" \"{}\"", value);
    else if constexpr (std::is_enum_v<T>)
      text_ += fmt::format(" {}", static_cast<std::int64_t>(value));
    else if constexpr (std::is_arithmetic_v<T>)
      text_ += fmt::format(" {}", +value);
    else if constexpr (std::is_same_v<T, std::byte>)
      text_ += fmt::format(" {:02x}", static_cast<unsigned>(value));
    else if constexpr (records::IsDescribed<T>)
      members(value);
    else if constexpr (std::is_same_v<T, records::FeatureObject>)
      add(value.image).add(value.time_gap_s).add(value.time_to_collision_s).add(value.warning);
    else if constexpr (std::is_same_v<T, std::optional<records::BelievedBox>>) {
      if (value) list(std::bit_cast<BoxNumbers>(*value));
    } else if constexpr (requires { value.ns; })
      text_ += fmt::format(" {}", value.ns);
    else
      list(value);
    return *this;
  }
  template <class Described> Line& members(const Described& value) {
    records::for_each_field<Described>([&](const auto& entry) { add(value.*entry.member); });
    return *this;
  }
  const std::string& text() const { return text_; }

 private:
  template <class List> void list(const List& items) {
    text_ += fmt::format(" [{}", items.size());
    for (const auto& item : items) add(item);
    text_ += "]";
  }
  std::string text_;
};

// Draws field values.
class Draw {
 public:
  Draw(int kind, Values values, std::uint32_t index, std::int64_t at)
      : values_(values), at_(at),
        stream_({.seed = 7, .purpose = Purpose::kTest, .entity = static_cast<std::uint16_t>(kind), .index = index}) {}

  template <class T> T get() {
    if constexpr (std::is_same_v<T, bool>)
      return get<std::uint8_t>() % 2 == 1;
    else if constexpr (std::is_same_v<T, double>)
      return number();
    else if constexpr (std::is_same_v<T, std::byte>)
      return static_cast<std::byte>(stream_.bits());
    else if constexpr (std::is_enum_v<T>)
      return static_cast<T>(get<std::underlying_type_t<T>>());
    else if constexpr (records::IsDescribed<T>) {
      T value{};
      members(value);
      return value;
    } else if constexpr (std::is_same_v<T, records::FeatureObject>)
      return {get<records::ImageObject>(), number(), number(), get<bool>()};
    else if constexpr (std::is_same_v<T, std::optional<records::BelievedBox>>) {
      if (!get<bool>()) return std::nullopt;
      return std::bit_cast<records::BelievedBox>(get<BoxNumbers>());
    } else if constexpr (std::is_same_v<T, BoxNumbers> || std::is_same_v<T, std::array<double, 4>>) {
      T numbers;
      for (double& one : numbers) one = number();
      return numbers;
    } else if constexpr (requires(T t) { t.ns; })
      return T{values_ == Values::kDrawn ? at_ + stream_.integer(0, 9'999) : get<std::int64_t>()};
    else {
      if (values_ == Values::kSmallest) return std::numeric_limits<T>::min();
      if (values_ == Values::kLargest) return std::numeric_limits<T>::max();
      return values_ == Values::kZero ? T{} : static_cast<T>(stream_.bits());
    }
  }
  // Draws all members of a record, or of a part of one.
  template <class Described> void members(Described& out) {
    records::for_each_field<Described>([&](const auto& entry) { draw(out, entry); });
  }

 private:
  template <class Record> void draw(Record& out, const auto& entry) { member<Record>(out.*entry.member, 0); }
  template <class Record, class Member, class Value>
  void draw(Record& out, const records::Field<Record, Member, records::Within<Value>>& field) {
    if constexpr (std::is_same_v<Member, Value>)
      out.*field.member = choice(field.range.low, field.range.high);
    else
      member<Record>(out.*field.member, field.range.high);
  }
  // `largest`: the size of a list, if it is said.
  template <class Record, class T> void member(T& out, std::size_t) { out = get<T>(); }
  template <class Record> void member(std::string_view& out, std::size_t) {
    out = *keep(std::make_shared<std::string>(words()));
  }
  template <class Record, class Item, std::size_t extent>
  void member(std::span<const Item, extent>& out, std::size_t largest) {
    if (largest == 0) largest = largest_of<Record, Item>();
    const auto items = keep(
        std::make_shared<std::vector<Item>>(extent == std::dynamic_extent ? list<Item>(largest) : fixed<Item>(extent)));
    out = std::span<const Item, extent>(items->data(), items->size());
  }
  template <class Record, class Item> static constexpr std::size_t largest_of() {
    if (std::is_same_v<Record, records::CanFrameSent>) return 64;
    if (std::is_same_v<Record, records::FusionInput>) return 5000;
    return std::is_same_v<Item, std::byte>       ? 262
           : std::is_same_v<Item, ObjectId>      ? 500
           : std::is_same_v<Item, MeasurementId> ? 255
                                                 : 25;
  }
  template <class T> std::shared_ptr<T> keep(std::shared_ptr<T> kept) {
    kept_.push_back(kept);
    return kept;
  }
  template <class T> T choice(T low, T high) {
    if (values_ == Values::kLargest) return high;
    if (values_ != Values::kDrawn) return low;
    return static_cast<T>(stream_.integer(static_cast<int>(low), static_cast<int>(high)));
  }
  template <class T> std::vector<T> list(std::size_t largest) {
    std::size_t count = 0;
    if (values_ == Values::kLargest) count = largest;
    if (values_ == Values::kDrawn) count = static_cast<std::size_t>(stream_.integer(0, 30));
    return fixed<T>(count);
  }
  template <class T> std::vector<T> fixed(std::size_t count) {
    std::vector<T> items;
    for (std::size_t i = 0; i < count; ++i) items.push_back(get<T>());
    return items;
  }
  // Printable, for text in the log is UTF-8.
  std::string words() {
    std::string text;
    for (const std::uint8_t letter : list<std::uint8_t>(300)) text += static_cast<char>(' ' + letter % 95);
    return text;
  }
  double number() {
    using Limits = std::numeric_limits<double>;
    switch (values_) {
      case Values::kZero: return -0.0;
      case Values::kSmallest: return Limits::denorm_min();
      case Values::kLargest: return Limits::infinity();
      case Values::kDrawn: break;
    }
    return std::bit_cast<double>(stream_.bits());  // any pattern, not-a-numbers with their payloads too
  }

  Values values_;
  std::int64_t at_;
  RandomStream stream_;
  std::vector<std::shared_ptr<void>> kept_;  // texts and lists, which records view
};

template <class Record> Record blank() { return {}; }
template <> records::TrackState blank() {
  static constexpr std::array<double, 36> kNothing{};
  return {.stamp = {}, .state = std::span(kNothing).first<6>(), .covariance = std::span(kNothing)};
}

class Text final : public records::Every<Text> {
 public:
  explicit Text(std::vector<std::string>& lines) : lines_(lines) {}
  template <class Record> void each(const Record& record) {
    lines_.push_back(Line(std::string(records::topic_of(records::kKindOf<Record>))).members(record).text());
  }

 private:
  std::vector<std::string>& lines_;
};

}  // namespace

std::unique_ptr<records::Sink> text_into(std::vector<std::string>& lines) { return std::make_unique<Text>(lines); }

void emit(records::Sink& sink, int kind, Values values, std::uint32_t index, std::int64_t at_ns) {
  const bool drawn = records::for_kind(static_cast<records::RecordKind>(kind), [&]<class Record>() {
    Draw draw(kind, values, index, at_ns);
    Record record = blank<Record>();
    draw.members(record);
    sink.on(record);
  });
  TTF_CHECK(drawn, "{} is no kind of record", kind);
}

}  // namespace ttf::recording
