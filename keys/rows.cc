#include "keys/rows.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>
#include <utility>

#include "core/counted.h"

namespace ttf::keys {
namespace {

using Conditions = std::vector<Condition>;

// Whether two conditions are about the same.
bool alike(const Condition& a, const Condition& b) { return a.key == b.key && a.of == b.of; }
bool equal(const Condition& a, const Condition& b) { return alike(a, b) && a.values == b.values; }

// The two as one, where they differ in the values of one condition only, in the last one if that is asked for.
bool join(Conditions& a, const Conditions& b, bool last_only) {
  if (a.size() != b.size()) return false;
  std::size_t differ = a.size();
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (!alike(a[i], b[i])) return false;
    if (equal(a[i], b[i])) continue;
    if (differ != a.size() || (last_only && i + 1 != a.size())) return false;
    differ = i;
  }
  if (differ != a.size())
    a[differ].values.insert(a[differ].values.end(), b[differ].values.begin(), b[differ].values.end());
  return true;
}

bool join_some(std::vector<Conditions>& list, bool last_only) {
  for (std::size_t a = 0; a < list.size(); ++a)
    for (std::size_t b = a + 1; b < list.size(); ++b)
      if (join(list[a], list[b], last_only)) {
        list.erase(list.begin() + static_cast<std::ptrdiff_t>(b));
        return true;
      }
  return false;
}

// Every value that the last of these conditions has in any case that agrees with those before it.
std::set<std::string> all_values(const Mapping& mapping, const Conditions& conditions) {
  std::set<std::string> all;
  for (const Case& one : mapping.cases) {
    if (one.conditions.size() < conditions.size()) continue;
    if (std::equal(conditions.begin(), conditions.end() - 1, one.conditions.begin(), equal)) {
      const auto& values = one.conditions[conditions.size() - 1].values;
      all.insert(values.begin(), values.end());
    }
  }
  return all;
}

// Drops conditions that do not matter: those with every possible value, and the presence of `key` itself.
void simplify(const Mapping& mapping, const std::string& key, std::vector<Conditions>& where) {
  for (bool again = true; again;) {
    again = join_some(where, true);
    for (Conditions& conditions : where) {
      if (conditions.empty()) continue;
      const Condition& last = conditions.back();
      const bool itself = last.of == Condition::Of::kPresence && last.key == key;
      if (!itself && std::set(last.values.begin(), last.values.end()) != all_values(mapping, conditions)) continue;
      conditions.pop_back();
      again = true;
    }
  }
  while (join_some(where, false)) {
  }
  for (Conditions& conditions : where)
    std::erase_if(conditions, [](const Condition& one) {
      return one.of == Condition::Of::kPresence && one.values.size() == 2;  // present or not
    });
}

class Walk {
 public:
  Walk(const Document& document, const Outline& outline) : document_(document), outline_(outline) {}

  std::vector<Row> rows() {
    mapping("");
    return std::move(rows_);
  }

 private:
  struct Spec {
    Key key;
    const Description* description = nullptr;
    std::vector<Conditions> where;
  };

  static bool same(const Spec& spec, const Key& key, const Description* description) {
    const KeyQuestion &a = spec.key.question, &b = key.question;
    return spec.description == description && a.key == b.key && a.type == b.type && a.optional == b.optional &&
           a.unit == b.unit && a.low == b.low && a.high == b.high && a.words == b.words && a.fallback == b.fallback;
  }

  void mapping(const std::string& path) {
    const Mapping* mapping = outline_.find(path);
    if (mapping == nullptr || !visited_.insert(path).second) return;
    std::vector<Spec> specs;
    for (const Case& one : mapping->cases)
      for (const Key& key : one.keys) {
        const Description* description = document_.describe(key.question.path(), one.conditions);
        const auto known =
            std::find_if(specs.begin(), specs.end(), [&](const Spec& spec) { return same(spec, key, description); });
        if (known == specs.end())
          specs.push_back({key, description, {one.conditions}});
        else
          known->where.push_back(one.conditions);
      }
    for (Spec& spec : specs) {
      const bool always = spec.where.size() == mapping->cases.size();
      const KeyQuestion question = spec.key.question;
      rows_.push_back({question.path(), std::move(spec.key), always ? "" : words(*mapping, question.key, spec.where),
                       spec.description, may_be_alike(mapping->cases)});
      within(question);
    }
  }

  void within(const KeyQuestion& question) {
    if (question.type == KeyType::kNamedTexts) {
      texts(question);
    } else if (question.type == KeyType::kNamedMaps && has_named_texts(outline_, question)) {
      const Key entry = outline_.find(question.path())->cases.front().keys.front();
      rows_.push_back({entry.question.path(), entry, "", document_.describe(entry.question.path(), {})});
      texts(entry.question);
    } else if (const std::string path = path_within(question); !path.empty()) {
      mapping(path);
    }
  }

  void texts(const KeyQuestion& question) {
    Key key = named_text(outline_, question);
    const std::string path = key.question.path();
    if (visited_.insert(path).second) rows_.push_back({path, std::move(key), "", document_.describe(path, {})});
  }

  static std::string words(const Mapping& mapping, const std::string& key, std::vector<Conditions> where) {
    simplify(mapping, key, where);
    std::vector<std::string> parts;
    for (const Conditions& conditions : where) {
      std::vector<std::string> some;
      for (const Condition& condition : conditions) some.push_back(words(mapping, condition));
      if (some.empty()) return "";
      parts.push_back(joined(some, " and "));
    }
    return fmt::format("{}", fmt::join(parts, ", or "));
  }

  static std::string words(const Mapping& mapping, const Condition& condition) {
    if (condition.of == Condition::Of::kPresence)
      return fmt::format("{} `{}`", condition.values.front() == "true" ? "with" : "without", condition.key);
    std::vector<std::string> others;
    for (const std::string& value : all_values(mapping, {condition}))
      if (std::find(condition.values.begin(), condition.values.end(), value) == condition.values.end())
        others.push_back(value);
    const bool most = !others.empty() && condition.values.size() > others.size() + 2;
    return most ? fmt::format("with any `{}` but `{}`", condition.key, fmt::join(others, "`, `"))
                : fmt::format("with `{}: {}`", condition.key, fmt::join(condition.values, "` or `"));
  }

  const Document& document_;
  const Outline& outline_;
  std::vector<Row> rows_;
  std::set<std::string> visited_;
};

}  // namespace

std::vector<Row> rows_of(const Document& document, const Outline& outline) { return Walk(document, outline).rows(); }

bool may_be_alike(const std::vector<Case>& cases) {
  return std::any_of(cases.begin(), cases.end(), [](const Case& one) {
    return std::any_of(one.keys.begin(), one.keys.end(),
                       [](const Key& key) { return key.question.key == kLike && key.question.optional; });
  });
}

std::string path_within(const KeyQuestion& question) {
  if (question.type == KeyType::kMap) return question.path();
  if (question.type == KeyType::kMaps) return question.path() + "[]";
  if (question.type == KeyType::kNamedMaps) return question.path() + "." + kAnyName;
  return "";
}

bool has_named_texts(const Outline& outline, const KeyQuestion& question) {
  return outline.find(question.path()) != nullptr;
}

Key named_text(const Outline& outline, const KeyQuestion& question) {
  if (const Mapping* read = outline.find(question.path()); read != nullptr && !read->cases.front().keys.empty())
    return read->cases.front().keys.front();
  Key key;
  key.question.map = question.path();
  key.question.key = kAnyName;
  key.question.type = KeyType::kText;
  key.question.optional = true;
  return key;
}

}  // namespace ttf::keys
