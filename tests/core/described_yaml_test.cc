// A described mapping asks one question per getter, with all that the getter was given, and takes the answer.
#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <vector>

#include "core/strict_yaml.h"

namespace ttf {
namespace {

// Answers everything alike and keeps the questions.
class Answers final : public KeyAnswers {
 public:
  explicit Answers(KeyValue value) : value_(std::move(value)) {}
  KeyValue answer(const KeyQuestion& question) override {
    questions.push_back(question);
    return value_;
  }
  std::vector<KeyQuestion> questions;

 private:
  KeyValue value_;
};

KeyQuestion asked(KeyValue answer, const std::function<void(YamlMap&)>& read) {
  Answers answers(std::move(answer));
  const StrictYaml yaml = StrictYaml::described(answers);
  Findings findings;
  YamlMap root = yaml.root(findings);
  read(root);
  root.fail("v", "must be anything else");
  root.finish();
  EXPECT_TRUE(findings.empty()) << "findings are passed over";
  EXPECT_EQ(answers.questions.size(), 1u);
  const KeyQuestion question = answers.questions.empty() ? KeyQuestion{} : answers.questions.front();
  EXPECT_EQ(question.path(), "v");
  return question;
}

const KeyValue kSeven = std::int64_t{7};

TEST(DescribedYaml, NumbersStateRangeUnitAndFallback) {
  KeyQuestion question = asked(kSeven, [](YamlMap& m) { EXPECT_EQ(m.integer("v", {1, 9}, "cycles"), 7); });
  EXPECT_EQ(question.type, KeyType::kInteger);
  EXPECT_FALSE(question.optional);
  EXPECT_EQ(question.low, KeyValue(std::int64_t{1}));
  EXPECT_EQ(question.high, KeyValue(std::int64_t{9}));
  EXPECT_EQ(question.unit, "cycles");
  EXPECT_EQ(question.fallback, std::nullopt);

  question = asked(kSeven, [](YamlMap& m) { EXPECT_EQ(m.integer_or("v", 3, {1, 9}), 7); });
  EXPECT_TRUE(question.optional);
  EXPECT_EQ(question.fallback, KeyValue(std::int64_t{3}));

  question = asked(0.5, [](YamlMap& m) { EXPECT_EQ(m.number("v", {0.0, 1.0}, "m"), 0.5); });
  EXPECT_EQ(question.type, KeyType::kNumber);
  EXPECT_EQ(question.high, KeyValue(1.0));
  question = asked(0.5, [](YamlMap& m) { EXPECT_EQ(m.number_or("v", 0.25, {0.0, 1.0}), 0.5); });
  EXPECT_EQ(question.fallback, KeyValue(0.25));

  question = asked(kSeven, [](YamlMap& m) { EXPECT_EQ(m.scaled("v", 1000, {0, 9000}, "ns"), 7); });
  EXPECT_EQ(question.type, KeyType::kDecimal);
  EXPECT_EQ(question.scale, 1000);

  question = asked(kSeven, [](YamlMap& m) { EXPECT_EQ(m.duration("v", {Duration{1}, Duration{9}}).ns, 7); });
  EXPECT_EQ(question.type, KeyType::kDuration);
  EXPECT_EQ(question.low, KeyValue(std::int64_t{1}));
  question = asked(kSeven, [](YamlMap& m) { EXPECT_EQ(m.duration_or("v", Duration{2}, {{}, Duration{9}}).ns, 7); });
  EXPECT_EQ(question.fallback, KeyValue(std::int64_t{2}));

  question = asked(kSeven, [](YamlMap& m) {
    EXPECT_EQ(m.integers("v", {1, 9}, "bits"), std::vector<std::int64_t>{7});
  });
  EXPECT_EQ(question.type, KeyType::kIntegers);
  EXPECT_EQ(question.unit, "bits");
}

TEST(DescribedYaml, FlagsTextsAndWordsStateTheirFallback) {
  KeyQuestion question = asked(true, [](YamlMap& m) { EXPECT_TRUE(m.boolean("v")); });
  EXPECT_EQ(question.type, KeyType::kBoolean);
  EXPECT_FALSE(question.optional);
  question = asked(true, [](YamlMap& m) { EXPECT_TRUE(m.boolean_or("v", false)); });
  EXPECT_EQ(question.fallback, KeyValue(false));

  question = asked(std::string("x"), [](YamlMap& m) { EXPECT_EQ(m.text("v"), "x"); });
  EXPECT_EQ(question.type, KeyType::kText);
  question = asked(std::string("x"), [](YamlMap& m) { EXPECT_EQ(m.text_or("v", "y"), "x"); });
  EXPECT_EQ(question.fallback, KeyValue(std::string("y")));

  const Choices<int> choices{{"slow", 10}, {"fast", 20}};
  question = asked(std::int64_t{1}, [&](YamlMap& m) { EXPECT_EQ(m.choice("v", choices), 20); });
  EXPECT_EQ(question.type, KeyType::kWord);
  EXPECT_EQ(question.words, (std::vector<std::string>{"slow", "fast"}));
  question = asked(std::int64_t{0}, [&](YamlMap& m) { EXPECT_EQ(m.choice_or("v", 20, choices), 10); });
  EXPECT_TRUE(question.optional);
  EXPECT_EQ(question.fallback, KeyValue(std::int64_t{1}));
  question = asked(std::int64_t{0}, [&](YamlMap& m) { EXPECT_EQ(m.choice_or("v", 30, choices), 10); });
  EXPECT_TRUE(question.optional);
  EXPECT_EQ(question.fallback, std::nullopt) << "no word of the choices";
}

TEST(DescribedYaml, PresenceIsAnswered) {
  EXPECT_EQ(asked(true, [](YamlMap& m) { EXPECT_TRUE(m.has("v")); }).type, KeyType::kIsThere);
  EXPECT_EQ(asked(false, [](YamlMap& m) { EXPECT_FALSE(m.map_if("v").has_value()); }).type, KeyType::kIsThere);
  EXPECT_EQ(asked(false, [](YamlMap& m) { EXPECT_TRUE(m.maps_if("v").empty()); }).type, KeyType::kIsThere);
}

TEST(DescribedYaml, AWordOrAMappingIsAskedFor) {
  Answers answers(true);
  Findings none;
  const StrictYaml yaml = StrictYaml::described(answers);
  EXPECT_TRUE(yaml.root(none).map_or_word("v", "word", "must be").has_value());
  ASSERT_EQ(answers.questions.size(), 2u);
  EXPECT_EQ(answers.questions[0].type, KeyType::kIsMap);
  EXPECT_EQ(answers.questions[1].type, KeyType::kMap);
}

TEST(DescribedYaml, MappingsAndListsHaveOneEntry) {
  EXPECT_EQ(asked(true, [](YamlMap& m) { EXPECT_EQ(m.map("v").path(), "v"); }).type, KeyType::kMap);
  EXPECT_EQ(asked(true,
                  [](YamlMap& m) {
                    const auto list = m.maps("v");
                    ASSERT_EQ(list.size(), 1u);
                    EXPECT_EQ(list.front().path(), "v[]");
                  })
                .type,
            KeyType::kMaps);
  EXPECT_EQ(asked(true,
                  [](YamlMap& m) {
                    const auto named = m.named_maps("v");
                    ASSERT_EQ(named.size(), 1u);
                    EXPECT_EQ(named.front().first, kAnyName);
                    EXPECT_EQ(named.front().second.path(), "v.NAME");
                  })
                .type,
            KeyType::kNamedMaps);
  EXPECT_EQ(asked(true, [](YamlMap& m) { EXPECT_EQ(m.texts("v"), std::vector<std::string>{kAnyName}); }).type,
            KeyType::kTexts);
  const std::vector<std::string> words{"slow", "fast"};
  const KeyQuestion question = asked(true, [&](YamlMap& m) { EXPECT_EQ(m.words("v", words).size(), 1u); });
  EXPECT_EQ(question.type, KeyType::kWords);
  EXPECT_EQ(question.words, words);
  EXPECT_EQ(asked(true, [](YamlMap& m) { EXPECT_EQ(m.named_texts("v").size(), 1u); }).type, KeyType::kNamedTexts);
}

TEST(DescribedYaml, PathsAreThoseOfTheMapping) {
  Answers answers(kSeven);
  Findings findings;
  const StrictYaml yaml = StrictYaml::described(answers);
  YamlMap root = yaml.root(findings);
  root.maps("list").front().map("inner").integer("v", {1, 9});
  EXPECT_EQ(answers.questions.back().map, "list[].inner");
  EXPECT_EQ(answers.questions.back().path(), "list[].inner.v");
}

}  // namespace
}  // namespace ttf
