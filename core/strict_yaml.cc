#include "core/strict_yaml.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <set>

#include "core/decimal.h"
#include "core/file_bytes.h"
#include "core/yaml_content.h"
#include "core/yaml_document.h"
#include "core/yaml_node.h"

namespace ttf {

namespace {

template <class T> std::optional<T> parse_number(std::string_view text) {
  T value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

// In a file a space separates number and unit.
std::optional<Duration> spaced_duration(const std::string& text) {
  return text.find(' ') == std::string::npos ? std::nullopt : parse_duration(text);
}

template <class T> std::string range_text(const Range<T>& range, std::string_view unit, std::string_view what) {
  return fmt::format("must be {} {}..{}{}{}", what, range.low, range.high, unit.empty() ? "" : " ", unit);
}

}  // namespace

YamlMap::YamlMap(std::shared_ptr<Content> content, std::string path, Findings* findings)
    : content_(std::move(content)), path_(std::move(path)), findings_(findings) {}

const std::string& YamlMap::file() const { return content_->file; }

std::string YamlMap::key_path(std::string_view key) const {
  if (path_.empty()) return std::string(key);
  if (key.empty()) return path_;
  return fmt::format("{}.{}", path_, key);
}

bool YamlMap::has(std::string_view key) const {
  if (is_described()) return std::get<bool>(ask(question(key, KeyType::kIsThere)));
  content_->asked.emplace(key);
  return content_->child(key).IsDefined();
}

bool YamlMap::is_map(std::string_view key) const {
  if (is_described()) return std::get<bool>(ask(question(key, KeyType::kIsMap)));
  const YAML::Node node = content_->child(key);
  return node.IsDefined() && node.IsMap();
}

int YamlMap::line(std::string_view key) const {
  if (!key.empty())
    if (const int own = line_of(content_->child(key)); own > 0) return own;  // 0: put there
  return content_->node.IsMap() ? line_of(content_->node) : content_->line;
}

void YamlMap::fail(std::string_view key, std::string expected) {
  if (is_described()) return;
  const YAML::Node node = content_->child(key);
  const std::string value = node.IsDefined() && node.IsScalar() ? node.Scalar() : "";
  fail(key, std::move(expected), value);
}

void YamlMap::fail(std::string_view key, std::string expected, std::string value) {
  if (is_described()) return;
  findings_->add({content_->file, line(key), key_path(key), std::move(value), std::move(expected)});
}

void YamlMap::gone(std::string_view key, std::string_view now) {
  if (is_described()) return;
  content_->gone.emplace(key);
  if (content_->child(key).IsDefined()) fail(key, fmt::format("is no key any longer: {}", now));
}

std::optional<std::string> YamlMap::scalar(std::string_view key, std::string_view expected) {
  content_->asked.emplace(key);
  const YAML::Node node = content_->child(key);
  if (!node.IsDefined()) {
    fail(key, fmt::format("is missing: {}", expected));
    return std::nullopt;
  }
  if (!node.IsScalar()) {
    fail(key, std::string(expected));
    return std::nullopt;
  }
  return node.Scalar();
}

std::int64_t YamlMap::integer(std::string_view key, Range<std::int64_t> allowed, std::string_view unit) {
  if (is_described()) return described(key, KeyType::kInteger, allowed, unit);
  const std::string expected = range_text(allowed, unit, "a whole number");
  const auto text = scalar(key, expected);
  if (!text) return allowed.low;
  const auto value = parse_number<std::int64_t>(*text);
  if (value && allowed.contains(*value)) return *value;
  fail(key, expected);
  return allowed.low;
}

std::int64_t YamlMap::integer_or(std::string_view key, std::int64_t fallback, Range<std::int64_t> allowed,
                                 std::string_view unit) {
  if (is_described()) return described(key, KeyType::kInteger, allowed, unit, std::optional(fallback));
  return has(key) ? integer(key, allowed, unit) : fallback;
}

std::optional<std::int64_t> YamlMap::integer_if(std::string_view key, Range<std::int64_t> allowed,
                                                std::string_view unit) {
  if (is_described()) return described(key, KeyType::kInteger, allowed, unit, std::optional<std::int64_t>{}, 1, true);
  return has(key) ? std::optional(integer(key, allowed, unit)) : std::nullopt;
}

double YamlMap::number(std::string_view key, Range<double> allowed, std::string_view unit) {
  if (is_described()) return described(key, KeyType::kNumber, allowed, unit);
  const std::string expected = range_text(allowed, unit, "a number");
  const auto text = scalar(key, expected);
  if (!text) return allowed.low;
  const auto value = parse_number<double>(*text);
  if (value && allowed.contains(*value)) return *value;
  fail(key, expected);
  return allowed.low;
}

double YamlMap::number_or(std::string_view key, double fallback, Range<double> allowed, std::string_view unit) {
  if (is_described()) return described(key, KeyType::kNumber, allowed, unit, std::optional(fallback));
  return has(key) ? number(key, allowed, unit) : fallback;
}

std::int64_t YamlMap::scaled(std::string_view key, std::int64_t scale, Range<std::int64_t> allowed,
                             std::string_view unit) {
  if (is_described()) return described(key, KeyType::kDecimal, allowed, unit, std::optional<std::int64_t>{}, scale);
  const auto unscaled = [&](std::int64_t value) { return static_cast<double>(value) / static_cast<double>(scale); };
  const std::string expected =
      range_text(Range<double>{unscaled(allowed.low), unscaled(allowed.high)}, unit, "a decimal number") +
      fmt::format(", in steps of {}", unscaled(1));
  const auto text = scalar(key, expected);
  if (!text) return allowed.low;
  const auto value = parse_scaled(*text, scale);
  if (value && allowed.contains(*value)) return *value;
  fail(key, expected);
  return allowed.low;
}

std::optional<std::int64_t> YamlMap::scaled_if(std::string_view key, std::int64_t scale, Range<std::int64_t> allowed,
                                               std::string_view unit) {
  if (is_described())
    return described(key, KeyType::kDecimal, allowed, unit, std::optional<std::int64_t>{}, scale, true);
  return has(key) ? std::optional(scaled(key, scale, allowed, unit)) : std::nullopt;
}

bool YamlMap::boolean(std::string_view key) {
  if (is_described()) return std::get<bool>(ask(question(key, KeyType::kBoolean)));
  constexpr std::string_view kExpected = "must be true or false";
  const auto text = scalar(key, kExpected);
  if (!text) return false;
  if (*text == "true") return true;
  if (*text != "false") fail(key, std::string(kExpected));
  return false;
}

bool YamlMap::boolean_or(std::string_view key, bool fallback) {
  if (is_described()) return std::get<bool>(ask(question(key, KeyType::kBoolean, fallback)));
  return has(key) ? boolean(key) : fallback;
}

std::string YamlMap::text(std::string_view key) {
  if (is_described()) return std::get<std::string>(ask(question(key, KeyType::kText)));
  constexpr std::string_view kExpected = "must be a text";
  const auto text = scalar(key, kExpected);
  if (text && text->empty()) fail(key, std::string(kExpected));
  return text.value_or("");
}

std::string YamlMap::text_or(std::string_view key, std::string_view fallback) {
  if (is_described()) return std::get<std::string>(ask(question(key, KeyType::kText, std::string(fallback))));
  return has(key) ? text(key) : std::string(fallback);
}

Duration YamlMap::duration(std::string_view key, Range<Duration> allowed) {
  if (is_described()) return described_duration(key, allowed, std::nullopt);
  const std::string expected = fmt::format("must be a time with its unit (ns, us, ms or s), {}..{}",
                                           duration_text(allowed.low), duration_text(allowed.high));
  const auto text = scalar(key, expected);
  if (!text) return allowed.low;
  const auto value = spaced_duration(*text);
  if (value && allowed.contains(*value)) return *value;
  fail(key, expected);
  return allowed.low;
}

Duration YamlMap::duration_or(std::string_view key, Duration fallback, Range<Duration> allowed) {
  if (is_described()) return described_duration(key, allowed, fallback);
  return has(key) ? duration(key, allowed) : fallback;
}

std::optional<Duration> YamlMap::duration_if(std::string_view key, Range<Duration> allowed) {
  if (is_described()) return described_duration(key, allowed, std::nullopt, true);
  return has(key) ? std::optional(duration(key, allowed)) : std::nullopt;
}

std::size_t YamlMap::choice_index(std::string_view key, const std::vector<std::string_view>& names) {
  if (is_described()) return described_choice(key, names, false, std::nullopt);
  const std::string expected = fmt::format("must be {}{}", names.size() > 1 ? "one of " : "", fmt::join(names, ", "));
  const auto text = scalar(key, expected);
  if (!text) return 0;
  const auto found = std::find(names.begin(), names.end(), *text);
  if (found == names.end()) {
    fail(key, expected);
    return 0;
  }
  return static_cast<std::size_t>(found - names.begin());
}

std::vector<YamlMap::Entry> YamlMap::entries(std::string_view key) {
  content_->asked.emplace(key);
  const YAML::Node node = content_->child(key);
  std::vector<Entry> list;
  if (!node.IsDefined() || !node.IsSequence() || node.size() == 0) {
    fail(key, node.IsDefined() ? "must be a list with at least one entry"
                               : "is missing: must be a list with at least one entry");
    return list;
  }
  std::size_t number = 0;
  for (const auto& item : node) {
    std::string path = fmt::format("{}[{}]", key_path(key), number++);
    if (item.IsScalar())
      list.push_back({item.Scalar(), std::move(path), line_of(item)});
    else
      findings_->add({content_->file, line_of(item), std::move(path), "", "must be a plain value"});
  }
  return list;
}

std::vector<std::string> YamlMap::texts(std::string_view key) {
  if (is_described()) {
    ask(question(key, KeyType::kTexts));
    return {kAnyName};
  }
  std::vector<std::string> list;
  for (Entry& entry : entries(key)) list.push_back(std::move(entry.text));
  return list;
}

std::vector<std::string> YamlMap::words(std::string_view key, const std::vector<std::string>& allowed) {
  if (is_described()) {
    KeyQuestion asked = question(key, KeyType::kWords);
    asked.words = allowed;
    ask(asked);
    return {allowed.front()};
  }
  std::vector<std::string> list;
  for (Entry& entry : entries(key))
    if (std::find(allowed.begin(), allowed.end(), entry.text) != allowed.end())
      list.push_back(std::move(entry.text));
    else
      findings_->add({content_->file, entry.line, entry.path, entry.text,
                      fmt::format("must be one of {}", fmt::join(allowed, ", "))});
  return list;
}

std::vector<std::int64_t> YamlMap::integers(std::string_view key, Range<std::int64_t> allowed, std::string_view unit) {
  if (is_described()) return {described(key, KeyType::kIntegers, allowed, unit)};
  const std::string expected = range_text(allowed, unit, "a whole number");
  std::vector<std::int64_t> list;
  for (const Entry& entry : entries(key)) {
    const auto value = parse_number<std::int64_t>(entry.text);
    if (value && allowed.contains(*value))
      list.push_back(*value);
    else
      findings_->add({content_->file, entry.line, entry.path, entry.text, expected});
  }
  return list;
}

void YamlMap::finish() {
  if (!content_->node.IsDefined() || !content_->node.IsMap()) return;
  std::set<std::string> seen;
  for (const auto& entry : content_->node) {
    const int line = line_of(entry.first);
    if (!entry.first.IsScalar()) {
      findings_->add({content_->file, line, path_, "", "has a key that is not a plain text"});
      continue;
    }
    const std::string& key = entry.first.Scalar();
    if (!seen.insert(key).second)
      findings_->add({content_->file, line, key_path(key), "", "is given twice in one mapping"});
    else if (!content_->asked.contains(key) && !content_->gone.contains(key))
      findings_->add({content_->file, line, key_path(key), "",
                      content_->asked.empty()
                          ? std::string("is not a known key here")
                          : fmt::format("is not a known key here (known: {})", fmt::join(content_->asked, ", "))});
  }
}

StrictYaml StrictYaml::load(const std::string& path) { return parse(read_file(path), path); }

StrictYaml StrictYaml::parse(std::string text, std::string name) {
  StrictYaml document;
  document.name_ = std::move(name);
  document.text_ = std::move(text);
  document.content_ = std::make_shared<YamlMap::Content>();
  document.content_->file = document.name_;
  document.content_->node.reset(parse_document(document.text_, document.name_));
  if (!document.content_->node.IsMap())
    throw InputError({document.name_, 1, "", "", "must be a YAML mapping at the top level"});
  return document;
}

YamlMap StrictYaml::root(Findings& findings) const {
  auto content = std::make_shared<YamlMap::Content>();
  content->file = content_->file;
  content->answers = content_->answers;
  content->node.reset(content_->node);
  return YamlMap(std::move(content), "", &findings);
}

void StrictYaml::put(const std::vector<std::string>& path, const std::string& value) {
  YAML::Node node;
  node.reset(content_->node);
  for (std::size_t i = 0; i + 1 < path.size(); ++i) {
    const auto index = node.IsSequence() ? parse_number<std::size_t>(path[i]) : std::nullopt;
    YAML::Node next = index && *index < node.size() ? node[*index] : child(node, path[i]);
    if (!next.IsDefined()) return;
    node.reset(next);
  }
  if (node.IsMap()) node[path.back()] = value;
}

void StrictYaml::take(std::string_view key) { content_->node.remove(std::string(key)); }

}  // namespace ttf
