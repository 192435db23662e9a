// The questions by which a loader reads keys. YamlMap answers them from a file. Without a file KeyAnswers answers, and
// collects the keys that the loader reads (keys/described_reading.h).
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace ttf {

enum class KeyType : std::uint8_t {
  kIsThere,  // has()
  kIsMap,    // map_or_word()
  kBoolean,
  kInteger,
  kNumber,
  kDecimal,  // scaled()
  kDuration,
  kText,
  kWord,  // choice()
  kMap,
  kMaps,
  kTexts,
  kWords,  // words()
  kIntegers,
  kNamedMaps,
  kNamedTexts,
};

// A duration is in nanoseconds. A decimal is multiplied by its scale. A word is its index among the words.
using KeyValue = std::variant<bool, std::int64_t, double, std::string>;

struct KeyQuestion {
  std::string map;  // "nodes.NAME", "frames[]"; empty: the whole file
  std::string key;
  KeyType type{};
  bool optional = false;             // a getter with a fallback
  std::optional<KeyValue> fallback;  // absent where the default is not a value of the key
  KeyValue low, high;                // numbers and durations
  std::string unit;
  std::int64_t scale = 1;          // decimals
  std::vector<std::string> words;  // kWord, kWords

  std::string path() const { return map.empty() ? key : map + "." + key; }
};

// Stands for any name in a path, and answers questions for a text.
inline constexpr const char* kAnyName = "NAME";

class KeyAnswers {
 public:
  virtual ~KeyAnswers() = default;
  // Returns a bool for kIsThere, kIsMap and kBoolean, a double for kNumber and a std::string for kText. For kInteger,
  // kIntegers, kDecimal, kDuration and kWord it is a std::int64_t. For the other types the answer has no effect.
  virtual KeyValue answer(const KeyQuestion& question) = 0;
};

}  // namespace ttf
