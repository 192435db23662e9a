// The half of YamlMap that has no file: each getter becomes a question.
#include <memory>
#include <utility>

#include "core/strict_yaml.h"
#include "core/yaml_content.h"

namespace ttf {

bool YamlMap::is_described() const { return content_->answers != nullptr; }

KeyQuestion YamlMap::question(std::string_view key, KeyType type, std::optional<KeyValue> fallback) const {
  KeyQuestion question;
  question.map = path_;
  question.key = key;
  question.type = type;
  question.optional = fallback.has_value();
  question.fallback = std::move(fallback);
  return question;
}

KeyValue YamlMap::ask(const KeyQuestion& question) const { return content_->answers->answer(question); }

template <class T>
T YamlMap::described(std::string_view key, KeyType type, Range<T> allowed, std::string_view unit,
                     std::optional<T> fallback, std::int64_t scale, bool optional) const {
  KeyQuestion asked = question(key, type, fallback ? std::optional<KeyValue>(*fallback) : std::nullopt);
  asked.optional = asked.optional || optional;
  asked.low = allowed.low;
  asked.high = allowed.high;
  asked.unit = unit;
  asked.scale = scale;
  return std::get<T>(ask(asked));
}

template std::int64_t YamlMap::described(std::string_view, KeyType, Range<std::int64_t>, std::string_view,
                                         std::optional<std::int64_t>, std::int64_t, bool) const;
template double YamlMap::described(std::string_view, KeyType, Range<double>, std::string_view, std::optional<double>,
                                   std::int64_t, bool) const;

Duration YamlMap::described_duration(std::string_view key, Range<Duration> allowed, std::optional<Duration> fallback,
                                     bool optional) const {
  const auto ns = fallback ? std::optional(fallback->ns) : std::nullopt;
  return Duration{
      described(key, KeyType::kDuration, Range<std::int64_t>{allowed.low.ns, allowed.high.ns}, "", ns, 1, optional)};
}

std::size_t YamlMap::described_choice(std::string_view key, const std::vector<std::string_view>& names, bool optional,
                                      std::optional<std::size_t> fallback) const {
  KeyQuestion asked = question(key, KeyType::kWord);
  asked.words.assign(names.begin(), names.end());
  asked.optional = optional;
  if (fallback) asked.fallback = static_cast<std::int64_t>(*fallback);
  return static_cast<std::size_t>(std::get<std::int64_t>(ask(asked)));
}

YamlMap YamlMap::described_map(std::string path) const {
  auto content = std::make_shared<Content>();
  content->file = content_->file;
  content->answers = content_->answers;
  return YamlMap(std::move(content), std::move(path), findings_);
}

StrictYaml StrictYaml::described(KeyAnswers& answers) {
  StrictYaml document;
  document.name_ = "description.yaml";
  document.content_ = std::make_shared<YamlMap::Content>();
  document.content_->file = document.name_;
  document.content_->answers = &answers;
  return document;
}

}  // namespace ttf
