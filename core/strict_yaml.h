// A strict reader of YAML mappings: unknown, missing, duplicate, mistyped and out-of-range keys are findings. A
// finding has file, line, key, value and allowed range; a default with a warning never replaces it.
//
//   StrictYaml file = StrictYaml::load("clusters/paper.yaml");     // throws InputError on unreadable or broken YAML
//   Findings findings;
//   YamlMap root = file.root(findings);
//   const auto slots = root.integer("gNumberOfStaticSlots", {2, 1023});
//   root.finish();                                                 // reports keys that were not read as unknown
//   findings.throw_if_any();                                       // all mistakes at once
//
// A getter without a usable value adds its finding and returns a value inside the range. Reading continues, so
// that later mistakes are found too. Getters with a fallback do not require the key.
//
// StrictYaml::described() has no file: KeyAnswers answers the getters, and collects the keys that a loader reads. Each list
// and each named mapping has one entry there, and findings are ignored.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/errors.h"
#include "core/key_question.h"
#include "core/time.h"

namespace ttf {

template <class T> struct Range {
  T low;
  T high;
  bool contains(T value) const { return value >= low && value <= high; }
};

template <class Enum> using Choices = std::vector<std::pair<std::string_view, Enum>>;

class YamlMap {
 public:
  bool has(std::string_view key) const;
  // Returns whether the file lacks the key. Described files never do.
  bool lacks(std::string_view key) const { return !is_described() && !has(key); }

  std::int64_t integer(std::string_view key, Range<std::int64_t> allowed, std::string_view unit = "");
  std::int64_t integer_or(std::string_view key, std::int64_t fallback, Range<std::int64_t> allowed,
                          std::string_view unit = "");
  // Returns none for an absent key: then other keys give the value.
  std::optional<std::int64_t> integer_if(std::string_view key, Range<std::int64_t> allowed, std::string_view unit = "");
  double number(std::string_view key, Range<double> allowed, std::string_view unit = "");
  double number_or(std::string_view key, double fallback, Range<double> allowed, std::string_view unit = "");
  // A decimal number times `scale`, which must be whole: "12.5" with scale 1000 is 12500 (ns to ps).
  std::int64_t scaled(std::string_view key, std::int64_t scale, Range<std::int64_t> allowed,
                      std::string_view unit = "");
  std::optional<std::int64_t> scaled_if(std::string_view key, std::int64_t scale, Range<std::int64_t> allowed,
                                        std::string_view unit = "");
  bool boolean(std::string_view key);
  bool boolean_or(std::string_view key, bool fallback);
  std::string text(std::string_view key);
  std::string text_or(std::string_view key, std::string_view fallback);
  // "40 ms", "2.5 us", "100 ns", "1.5 s"; exact to the nanosecond.
  Duration duration(std::string_view key, Range<Duration> allowed);
  Duration duration_or(std::string_view key, Duration fallback, Range<Duration> allowed);
  std::optional<Duration> duration_if(std::string_view key, Range<Duration> allowed);

  template <class Enum> Enum choice(std::string_view key, const Choices<Enum>& choices) {
    std::vector<std::string_view> names;
    for (const auto& entry : choices) names.push_back(entry.first);
    return choices[choice_index(key, names)].second;
  }
  template <class Enum> Enum choice_or(std::string_view key, Enum fallback, const Choices<Enum>& choices) {
    if (!is_described()) return has(key) ? choice(key, choices) : fallback;
    std::vector<std::string_view> names;
    std::optional<std::size_t> otherwise;
    for (const auto& entry : choices) {
      if (entry.second == fallback) otherwise = names.size();
      names.push_back(entry.first);
    }
    return choices[described_choice(key, names, true, otherwise)].second;
  }
  template <class Enum> std::optional<Enum> choice_if(std::string_view key, const Choices<Enum>& choices) {
    if (!is_described()) return has(key) ? std::optional(choice(key, choices)) : std::nullopt;
    std::vector<std::string_view> names;
    for (const auto& entry : choices) names.push_back(entry.first);
    return choices[described_choice(key, names, true, std::nullopt)].second;
  }

  YamlMap map(std::string_view key);  // a missing map is a finding and reads as empty
  std::optional<YamlMap> map_if(std::string_view key);
  // A mapping, or none where the word stands instead of it. All else is a finding with `expected`, and none.
  std::optional<YamlMap> map_or_word(std::string_view key, std::string_view word, std::string_view expected);
  std::vector<YamlMap> maps(std::string_view key);     // a sequence of mappings
  std::vector<YamlMap> maps_if(std::string_view key);  // the same, empty when the key is absent
  // A sequence with at least one entry. A wrong entry is a finding about key[i] and is left out.
  std::vector<std::string> texts(std::string_view key);
  std::vector<std::string> words(std::string_view key, const std::vector<std::string>& allowed);
  std::vector<std::int64_t> integers(std::string_view key, Range<std::int64_t> allowed, std::string_view unit = "");
  std::vector<std::pair<std::string, YamlMap>> named_maps(std::string_view key);       // name: {...}, in file order
  std::vector<std::pair<std::string, std::string>> named_texts(std::string_view key);  // name: text, in file order
  // The keys of this mapping that were not asked for yet: name: {...}, in file order.
  std::vector<std::pair<std::string, YamlMap>> other_maps();

  // Reads the keys that this mapping lacks from the other one, where findings find their lines, too. No key of the other one is
  // unknown. It must not inherit from this one.
  void inherit(const YamlMap& other);
  // Returns whether the file has the key in this mapping itself. Described files never have it.
  bool has_own(std::string_view key) const;
  // Returns the keys that were asked for and that another mapping gives.
  std::vector<std::string> inherited() const;

  // Returns the value on one line, lists and mappings, too: "[laser]". An empty text is two quotes, an empty value "~".
  std::string value_text(std::string_view key);
  // Refuses a misspelt `key`, if this mapping lacks the right one, and proposes it (core/nearest.h). Returns whether there is one.
  bool refuse_misspelt(std::string_view key);
  // Adds no findings from now on: they would follow from an earlier one. Mappings within must not outlive this one.
  void mute();

  // Refuses a key that earlier versions had; `now` says what stands for it. It is not among the known keys.
  void gone(std::string_view key, std::string_view now);

  // Adds a finding about `key` (about this mapping when `key` is empty), with its line and value. The value is a plain one, or the
  // text that is given for it.
  void fail(std::string_view key, std::string expected);
  void fail(std::string_view key, std::string expected, std::string value);
  int line(std::string_view key = "") const;
  const std::string& file() const;
  const std::string& path() const { return path_; }

  // Reports every key that was never read, and duplicate keys.
  void finish();

 private:
  friend class StrictYaml;
  struct Content;
  YamlMap(std::shared_ptr<Content> content, std::string path, Findings* findings);
  std::size_t choice_index(std::string_view key, const std::vector<std::string_view>& names);
  bool is_described() const;
  bool is_map(std::string_view key) const;
  KeyQuestion question(std::string_view key, KeyType type, std::optional<KeyValue> fallback = std::nullopt) const;
  KeyValue ask(const KeyQuestion& question) const;
  template <class T>
  T described(std::string_view key, KeyType type, Range<T> allowed, std::string_view unit = "",
              std::optional<T> fallback = std::nullopt, std::int64_t scale = 1, bool optional = false) const;
  Duration described_duration(std::string_view key, Range<Duration> allowed, std::optional<Duration> fallback,
                              bool optional = false) const;
  std::size_t described_choice(std::string_view key, const std::vector<std::string_view>& names, bool optional,
                               std::optional<std::size_t> fallback) const;
  YamlMap described_map(std::string path) const;
  std::string key_path(std::string_view key) const;
  struct Entry {
    std::string text, path;
    int line = 0;
  };
  std::vector<Entry> entries(std::string_view key);
  std::optional<std::string> scalar(std::string_view key, std::string_view expected);

  std::shared_ptr<Content> content_;
  std::string path_;
  Findings* findings_;
};

// One YAML document of printable text. A second document or a control character is a finding: the parser would
// silently skip the rest of the text.
class StrictYaml {
 public:
  static StrictYaml load(const std::string& path);
  static StrictYaml parse(std::string text, std::string name);
  static StrictYaml described(KeyAnswers& answers);  // they must live as long as the mappings

  YamlMap root(Findings& findings) const;

  // Puts a scalar into a mapping of the file, for a reader that demands it. The path leads through keys, and through lists by
  // an index: {"frames", "3", "slot"}. Findings about it name the mapping's line. Nothing happens where the path leads nowhere.
  void put(const std::vector<std::string>& path, const std::string& value);
  // Takes a key away from the top level.
  void take(std::string_view key);

  const std::string& text() const { return text_; }
  const std::string& name() const { return name_; }

 private:
  StrictYaml() = default;
  std::string name_;
  std::string text_;
  std::shared_ptr<YamlMap::Content> content_;
};

}  // namespace ttf
