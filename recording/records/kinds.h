// Kinds of record by number, as in logs.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <type_traits>
#include <utility>

#include "recording/records/records.h"

namespace ttf::recording::records {

// From 1 to kKindCount. A number read from a file may be outside, and is then no kind.
enum class RecordKind : std::uint8_t {};
constexpr std::size_t number_of(RecordKind kind) { return static_cast<std::size_t>(kind); }
constexpr bool is_kind(std::size_t number) { return number >= 1 && number <= kKindCount; }

// Calls `f.operator()<Record>()` for the record of every kind, in the order of the list.
template <class F> constexpr void for_each_kind(F&& f) {
  [&]<std::size_t... i>(std::index_sequence<i...>) { (f.template operator()<RecordAt<i + 1>>(), ...); }
  (std::make_index_sequence<kKindCount>{});
}

template <class Record, class F> void call_for(F& f) { f.template operator()<Record>(); }
// Calls `f` for the record of one kind. Returns false if the number is no kind.
template <class F> bool for_kind(RecordKind kind, F&& f) {
  using Call = void (*)(std::remove_reference_t<F>&);
  static constexpr auto kCalls = []<std::size_t... i>(std::index_sequence<i...>) {
    return std::array<Call, kKindCount>{&call_for<RecordAt<i + 1>, std::remove_reference_t<F>>...};
  }
  (std::make_index_sequence<kKindCount>{});
  if (!is_kind(number_of(kind))) return false;
  kCalls[number_of(kind) - 1](f);
  return true;
}

template <class Record> inline constexpr RecordKind kKindOf = static_cast<RecordKind>(kKinds.number_of<Record>());

// Indexed by number - 1.
inline constexpr auto kTopics = kKinds.topics;
constexpr std::string_view topic_of(RecordKind kind) { return kTopics[number_of(kind) - 1]; }
constexpr bool counts_in_hash(RecordKind kind) { return kKinds.in_hash[number_of(kind) - 1]; }

}  // namespace ttf::recording::records
