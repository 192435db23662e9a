// Kinds of record by number, as in logs.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <tuple>
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

// Calls `f` for the record of one kind. Returns false if the number is no kind.
template <class F> constexpr bool for_kind(RecordKind kind, F&& f) {
  return [&]<std::size_t... i>(std::index_sequence<i...>) {
    return ((number_of(kind) == i + 1 && (f.template operator()<RecordAt<i + 1>>(), true)) || ...);
  }
  (std::make_index_sequence<kKindCount>{});
}

template <class Record> constexpr RecordKind kind_of() {
  std::size_t number = 0, at = 0;
  for_each_kind([&]<class Other>() {
    ++at;
    if (std::is_same_v<Record, Other>) number = at;
  });
  return static_cast<RecordKind>(number);
}
template <class Record> inline constexpr RecordKind kKindOf = kind_of<Record>();

// Indexed by number - 1.
inline constexpr auto kTopics =
    std::apply([](const auto&... kind) { return std::array<std::string_view, kKindCount>{kind.topic...}; }, kKinds);
constexpr std::string_view topic_of(RecordKind kind) { return kTopics[number_of(kind) - 1]; }
constexpr bool counts_in_hash(RecordKind kind) {
  constexpr auto kInHash =
      std::apply([](const auto&... each) { return std::array<bool, kKindCount>{each.in_hash...}; }, kKinds);
  return kInHash[number_of(kind) - 1];
}

}  // namespace ttf::recording::records
