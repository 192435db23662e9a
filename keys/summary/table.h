// An object of JSON as a table: a row is a member, with its key, its value and its meaning. Writing and description follow
// from the same rows, and the type of a member follows from that of its value:
//   - a std::optional or a pointer is null without a value
//   - a list of pairs, each with a text, is an object with any names
//   - a value with rows of its own is an object
#pragma once

#include <concepts>
#include <cstdint>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace ttf::keys::summary {

using Json = nlohmann::ordered_json;

// A member as people and schemas see it.
struct Member {
  std::string path;     // "strategies[].nees.mean"; [] stands for each entry of a list, NAME for any name
  std::string type;     // a type of JSON; "number or null"
  std::string meaning;  // a sentence without its full stop, with the unit
  bool optional = false;
};

inline std::string below(const std::string& place, const std::string& path) {
  return place.empty() || path.empty() ? place + path : place + "." + path;
}

template <class V> constexpr bool kText = std::convertible_to<const V&, std::string_view>;
template <class V> constexpr bool kMaybe = !kText<V> && requires(const V& maybe) { static_cast<bool>(maybe), *maybe; };
template <class V> constexpr bool kList = !kText<V> && requires(const V& list) { list.begin(); };
template <class V> constexpr bool kNamed = kList<V>&& requires(const V& list) { list.begin()->second; };

// The value that may be there, an entry of a list, or else the value itself.
template <class V> constexpr auto inner_of(const V& value) {
  if constexpr (kMaybe<V>)
    return *value;
  else if constexpr (kNamed<V>)
    return value.begin()->second;
  else if constexpr (kList<V>)
    return *value.begin();
  else
    return value;
}
template <class V> using Inner = decltype(inner_of(std::declval<const V&>()));
template <class V> using Present = std::conditional_t<kMaybe<V>, Inner<V>, V>;
template <class V> using Entry = Present<Inner<Present<V>>>;  // the value itself, if it is no list

template <class V> std::string type_of() {
  if constexpr (kMaybe<V>)
    return type_of<Inner<V>>() + " or null";
  else if constexpr (kList<V>)
    return kNamed<V> ? "object" : "array";
  else if constexpr (std::same_as<V, bool>)
    return "boolean";
  else if constexpr (std::is_arithmetic_v<V>)
    return std::integral<V> ? "integer" : "number";
  else
    return kText<V> ? "string" : "object";
}

// `one` writes a number, a text or an object in the value.
template <class V, class One> Json written(const V& value, const One& one) {
  if constexpr (kMaybe<V>) {
    return value ? written(*value, one) : Json(nullptr);
  } else if constexpr (kNamed<V>) {
    Json all = Json::object();
    for (const auto& [name, entry] : value) all[name] = written(entry, one);
    return all;
  } else if constexpr (kList<V>) {
    Json all = Json::array();
    for (const auto& entry : value) all.push_back(written(entry, one));
    return all;
  } else {
    return one(value);
  }
}

// A member may be absent where its value is null, or where it is null or empty.
enum class Absent : std::uint8_t { kNever, kIfNull, kIfEmpty };

template <class Of> struct Row;
template <class Of> using Rows = std::vector<Row<Of>>;
template <class Of> Json json_of(const Rows<Of>& rows, const Of& of);
template <class Of> std::vector<Member> described(const Rows<Of>& rows, const std::string& place = "");

// A member of the JSON of an `Of`. Its value is a function of it. Without a key, the members of its object join the others.
template <class Of> struct Row {
  std::string key;
  Absent absent = Absent::kNever;
  std::function<Json(const Of&)> json;
  std::vector<Member> members;  // it, and those in it

  template <class Value> using Result = std::remove_cvref_t<std::invoke_result_t<Value, const Of&>>;

  Row(std::function<Json(const Of&)> object, std::vector<Member> its)
      : json(std::move(object)), members(std::move(its)) {}
  // A number, a text, or a list of them; `each` is the meaning of the list's entries.
  template <class Value>
  Row(const char* name, Value value, const char* meaning, const char* each = nullptr, Absent may_be = Absent::kNever)
      : Row(name, may_be, meaning, std::type_identity<Result<Value>>{}) {
    json = [value](const Of& of) { return written(value(of), [](const auto& one) { return Json(one); }); };
    if (each != nullptr) members.push_back({place<Result<Value>>(), type_of<Inner<Present<Result<Value>>>>(), each});
  }
  // An object, or a list of them; `rows` are those of each.
  template <class Value>
  Row(const char* name, Value value, const char* meaning, const Rows<Entry<Result<Value>>>& rows,
      Absent may_be = Absent::kNever)
      : Row(name, may_be, meaning, std::type_identity<Result<Value>>{}) {
    json = [value, rows](const Of& of) {
      return written(value(of), [&rows](const Entry<Result<Value>>& one) { return json_of(rows, one); });
    };
    for (Member& member : described(rows, place<Result<Value>>())) members.push_back(std::move(member));
  }

 private:
  template <class V>
  Row(const char* name, Absent may_be, const char* meaning, std::type_identity<V> /*value*/)
      : key(name), absent(may_be) {
    const bool optional = absent != Absent::kNever;
    members.push_back({key, optional ? type_of<Present<V>>() : type_of<V>(), meaning, optional});
  }
  // The place of its parts.
  template <class V> std::string place() const {
    return key + (kNamed<Present<V>> ? ".NAME" : kList<Present<V>> ? "[]" : "");
  }
};

template <class Of> Json json_of(const Rows<Of>& rows, const Of& of) {
  Json object = Json::object();
  for (const Row<Of>& row : rows) {
    Json value = row.json(of);
    if (row.key.empty())
      object.update(value);
    else if (row.absent == Absent::kIfEmpty ? !value.empty() : row.absent == Absent::kNever || !value.is_null())
      object[row.key] = std::move(value);
  }
  return object;
}

template <class Of> std::vector<Member> described(const Rows<Of>& rows, const std::string& place) {
  std::vector<Member> all;
  for (const Row<Of>& row : rows)
    for (const Member& member : row.members)
      all.push_back({below(place, member.path), member.type, member.meaning, member.optional});
  return all;
}

}  // namespace ttf::keys::summary
