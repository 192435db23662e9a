#include "keys/value_words.h"

#include <fmt/format.h>

#include <set>
#include <vector>

#include "core/counted.h"
#include "core/decimal.h"

namespace ttf::keys {
namespace {

std::string in_unit(const KeyQuestion& question, const KeyValue& value) {
  if (const double* number = std::get_if<double>(&value)) return fmt::format("{}", *number);
  const std::int64_t whole = std::get<std::int64_t>(value);
  if (question.type == KeyType::kDuration) return duration_text(whole);
  return scaled_text(whole, question.type == KeyType::kDecimal ? question.scale : 1);
}

std::string range(const Key& key, const std::string& what, const std::string& mark) {
  const KeyQuestion& question = key.question;
  std::string words = fmt::format("{} {}..{}", what, in_unit(question, question.low), in_unit(question, question.high));
  if (!question.unit.empty()) words += " " + question.unit;
  if (key.bounds_by.empty()) return words;
  std::vector<std::string> causes;
  for (const std::string& cause : key.bounds_by) causes.push_back(mark + cause + mark);
  return fmt::format("{}, bounded by {}", words, joined(causes, " and "));
}

std::string any_of(const std::vector<std::string>& words, const std::string& mark) {
  std::vector<std::string> marked;
  for (const std::string& word : words) marked.push_back(mark + word + mark);
  return joined(marked, " or ");
}

}  // namespace

std::string duration_text(std::int64_t ns) {
  const std::int64_t size = ns < 0 ? -ns : ns;
  if (size >= 1'000'000'000) return scaled_text(ns, 1'000'000'000) + " s";
  if (size >= 1'000'000 || ns == 0) return scaled_text(ns, 1'000'000) + " ms";
  if (size >= 1'000) return scaled_text(ns, 1'000) + " us";
  return fmt::format("{} ns", ns);
}

std::string value_words(const Key& key, const std::string& mark) {
  const KeyQuestion& question = key.question;
  switch (question.type) {
    case KeyType::kBoolean: return any_of({"true", "false"}, mark);
    case KeyType::kInteger: return range(key, "whole number", mark);
    case KeyType::kNumber: return range(key, "number", mark);
    case KeyType::kDecimal: return range(key, "decimal number", mark);
    case KeyType::kDuration: return range(key, "time", mark);
    case KeyType::kText: return "text";
    case KeyType::kWord: return any_of(question.words, mark);
    case KeyType::kMap: return key.words.empty() ? "mapping" : any_of(key.words, mark) + ", or a mapping";
    case KeyType::kMaps: return "list of mappings";
    case KeyType::kTexts: return "list of texts";
    case KeyType::kWords: return "list of " + any_of(question.words, mark);
    case KeyType::kIntegers: return range(key, "list of whole numbers", mark);
    case KeyType::kNamedMaps: return "mappings by name";
    case KeyType::kNamedTexts: return "values by name";
    case KeyType::kIsThere:
    case KeyType::kIsMap: break;
  }
  return "";
}

std::optional<std::string> default_text(const Key& key) {
  const KeyQuestion& question = key.question;
  if (!question.fallback || !key.default_by.empty()) return std::nullopt;
  const KeyValue& value = *question.fallback;
  if (const bool* flag = std::get_if<bool>(&value)) return *flag ? "true" : "false";
  if (const std::string* text = std::get_if<std::string>(&value))
    return text->empty() ? std::nullopt : std::optional(*text);
  if (question.type == KeyType::kWord)
    return question.words.at(static_cast<std::size_t>(std::get<std::int64_t>(value)));
  if (value < question.low || value > question.high) return std::nullopt;
  return in_unit(question, value);
}

std::string need_words(const Key& key, bool may_be_alike, const std::string& mark) {
  if (key.question.key == kAnyName) return "";
  if (!key.question.optional) return may_be_alike ? fmt::format("required without {0}like{0}", mark) : "required";
  if (!key.default_by.empty()) {
    std::vector<std::string> causes;
    for (const std::string& cause : key.default_by) causes.push_back(mark + cause + mark);
    return "default depends on " + joined(causes, " and ");
  }
  const auto text = default_text(key);
  return text ? "default " + mark + *text + mark : "optional";
}

}  // namespace ttf::keys
