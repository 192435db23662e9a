#include "keys/described_reading.h"

#include <algorithm>
#include <utility>

namespace ttf::keys {
namespace {

template <class List, class Value> bool contains(const List& list, const Value& value) {
  return std::find(list.begin(), list.end(), value) != list.end();
}

}  // namespace

DescribedReading::DescribedReading(Answers answers, Numbers numbers)
    : answers_(std::move(answers)), numbers_(numbers) {}

KeyValue DescribedReading::decide(const std::string& name, const KeyQuestion& question, KeyValue usual) {
  const auto given = answers_.find(name);
  KeyValue answer = given == answers_.end() ? std::move(usual) : given->second;
  if (numbers_ == Numbers::kUsual && decided_.insert(name).second) decisions_.push_back({name, question, answer});
  return answer;
}

KeyValue DescribedReading::number(const KeyQuestion& question) const {
  if (numbers_ == Numbers::kLeast) return question.low;
  if (numbers_ == Numbers::kLargest) return question.high;
  return question.fallback.value_or(question.low);
}

KeyValue DescribedReading::answer(const KeyQuestion& question) {
  const std::string path = question.path();
  const auto [place, is_new] = maps_.try_emplace(question.map);
  if (is_new) order_.push_back(question.map);
  Map& map = place->second;
  if (!contains(map.known, question.key)) map.known.push_back(question.key);

  if (question.type == KeyType::kIsThere) {
    if (required_.contains(path)) return true;
    asked_for_.insert(path);
    return decide(path + "?", question, true);
  }
  if (question.type == KeyType::kIsMap) return decide(path + "{}", question, true);

  const bool optional = question.optional || asked_for_.contains(path);
  if (!optional) required_.insert(path);
  if (std::none_of(map.questions.begin(), map.questions.end(),
                   [&](const KeyQuestion& q) { return q.key == question.key; })) {
    map.questions.push_back(question);
    map.questions.back().optional = optional;
  }

  switch (question.type) {
    case KeyType::kBoolean: return decide(path, question, question.fallback.value_or(false));
    case KeyType::kInteger:
    case KeyType::kNumber:
    case KeyType::kDecimal:
    case KeyType::kDuration:
    case KeyType::kIntegers: return decide(path, question, number(question));
    case KeyType::kText: {
      const auto word = chosen_words_.find(path);  // the same key read again, as a text
      return word == chosen_words_.end() ? std::get<std::string>(question.fallback.value_or(std::string(kAnyName)))
                                         : word->second;
    }
    case KeyType::kWord: {
      const auto word = chosen_words_.find(path);
      if (word != chosen_words_.end())
        if (const auto again = std::find(question.words.begin(), question.words.end(), word->second);
            again != question.words.end())
          return static_cast<std::int64_t>(again - question.words.begin());
      const KeyValue chosen = decide(path, question, question.fallback.value_or(std::int64_t{0}));
      chosen_words_[path] = question.words.at(static_cast<std::size_t>(std::get<std::int64_t>(chosen)));
      return chosen;
    }
    case KeyType::kIsThere:
    case KeyType::kIsMap:
    case KeyType::kMap:
    case KeyType::kMaps:
    case KeyType::kTexts:
    case KeyType::kWords:
    case KeyType::kNamedMaps:
    case KeyType::kNamedTexts: break;
  }
  return true;
}

}  // namespace ttf::keys
