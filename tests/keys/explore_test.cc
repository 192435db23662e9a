// Explores small loaders: conditions, bounds and defaults that other keys set, words or mappings.
#include "keys/explore.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "keys/outline.h"

namespace ttf::keys {
namespace {

using testing::ElementsAre;

Outline outline_of(const std::function<void(YamlMap&)>& read) {
  return outline(explore([&](const StrictYaml& yaml) {
    Findings findings;
    YamlMap root = yaml.root(findings);
    read(root);
  }));
}

// "kind: a, b -> x y?": conditions, and keys with a sign behind those that are optional.
std::vector<std::string> cases(const Outline& outline, const std::string& path) {
  std::vector<std::string> lines;
  const Mapping* mapping = outline.find(path);
  if (mapping == nullptr) return {"no such mapping"};
  for (const Case& one : mapping->cases) {
    std::string line;
    for (const Condition& condition : one.conditions) {
      line += condition.key + (condition.of == Condition::Of::kPresence ? "? " : ": ");
      for (const std::string& value : condition.values) line += value + " ";
    }
    line += "->";
    for (const Key& key : one.keys) line += " " + key.question.key + (key.question.optional ? "?" : "");
    lines.push_back(line);
  }
  return lines;
}

const Key& key_of(const Outline& outline, const std::string& path, const std::string& name) {
  for (const Key& key : outline.find(path)->cases.front().keys)
    if (key.question.key == name) return key;
  throw std::out_of_range(name);
}

TEST(Explore, KeysWithoutConditionsAreOneCase) {
  const Outline found = outline_of([](YamlMap& m) {
    m.integer("a", {1, 9});
    m.number_or("b", 0.5, {0.0, 1.0});
    if (m.has("c")) m.text("c");
    m.boolean_or("d", false);
    m.choice<int>("e", {{"x", 0}, {"y", 1}});
  });
  EXPECT_THAT(cases(found, ""), ElementsAre("-> a b? c? d? e"));
}

TEST(Explore, AWordThatDecidesMakesCases) {
  const Outline found = outline_of([](YamlMap& m) {
    const int kind = m.choice<int>("kind", {{"a", 0}, {"b", 1}, {"c", 2}, {"d", 3}});
    if (kind == 1) m.text("of_b");
    if (kind == 3 && m.boolean_or("deep", false)) m.text("of_deep");
  });
  EXPECT_THAT(cases(found, ""),
              ElementsAre("kind: a c -> kind", "kind: b -> kind of_b", "kind: d deep: false -> kind deep?",
                          "kind: d deep: true -> kind deep? of_deep"));
}

TEST(Explore, PresenceMakesCases) {
  const Outline found = outline_of([](YamlMap& m) {
    if (m.has("one"))
      m.text("one");
    else if (m.has("two"))
      m.text("two");
    else
      m.text("three");
  });
  EXPECT_THAT(cases(found, ""),
              ElementsAre("one? true -> one?", "one? false two? true -> two?", "one? false two? false -> three"));
}

TEST(Explore, TwoDecisionsThatMatterMakeAllTheirCases) {
  const Outline found = outline_of([](YamlMap& m) {
    if (m.boolean("p")) m.text("of_p");
    if (m.boolean("q")) m.text("of_q");
  });
  EXPECT_THAT(cases(found, ""), ElementsAre("p: false q: false -> p q", "p: false q: true -> p q of_q",
                                            "p: true q: false -> p of_p q", "p: true q: true -> p of_p q of_q"));
}

TEST(Explore, ABoundThatAnotherKeySetsIsTheWidest) {
  const Outline found = outline_of([](YamlMap& m) {
    const auto most = m.integer_or("most", 5, {1, 32});
    m.integer_or("some", 3, {1, most});
    m.integer("else", {0, 1});
  });
  const Key& some = key_of(found, "", "some");
  EXPECT_EQ(some.question.high, KeyValue(std::int64_t{32}));
  EXPECT_THAT(some.bounds_by, ElementsAre("most"));
  EXPECT_TRUE(some.default_by.empty());
  EXPECT_TRUE(key_of(found, "", "else").bounds_by.empty());
}

TEST(Explore, ADefaultThatAnotherKeySetsIsNone) {
  const Outline found = outline_of([](YamlMap& m) {
    const double low = m.number_or("low", 0.0, {-10.0, 10.0});
    m.number_or("high", low + 5.0, {-20.0, 20.0});
  });
  EXPECT_THAT(key_of(found, "", "high").default_by, ElementsAre("low"));
}

TEST(Explore, AWordOrAMapping) {
  const Outline found = outline_of([](YamlMap& m) {
    if (!m.has("start")) return;
    if (auto start = m.map_or_word("start", "cold", "")) start->integer("v", {0, 1});
  });
  const Key& start = key_of(found, "", "start");
  EXPECT_EQ(start.question.type, KeyType::kMap);
  EXPECT_TRUE(start.question.optional);
  EXPECT_THAT(start.words, ElementsAre("cold"));
  EXPECT_THAT(cases(found, "start"), ElementsAre("-> v"));
}

// No condition could say it.
TEST(Explore, AWordOrAMappingDecidesNoOtherKeys) {
  const auto decides = [](YamlMap& m) {
    YamlMap bus = m.map("bus");
    if (auto start = bus.map_or_word("start", "cold", "")) {
      start->integer("v", {0, 1});
      bus.integer("a", {1, 9});
    }
  };
  EXPECT_DEATH(outline_of(decides), "whether bus.start is a mapping decides which other keys there are");
}

TEST(Explore, AnyOtherNameIsAKeyBesideTheKnownOnes) {
  const Outline found = outline_of([](YamlMap& m) {
    if (auto usual = m.map_if("usual")) usual->integer("v", {0, 1});
    for (auto& [name, entry] : m.other_maps())
      if (entry.choice<int>("kind", {{"a", 0}, {"b", 1}}) == 1) entry.integer("of_b", {0, 1});
  });
  EXPECT_THAT(cases(found, ""), ElementsAre("-> usual? NAME?"));
  EXPECT_THAT(cases(found, "NAME"), ElementsAre("kind: a -> kind", "kind: b -> kind of_b"));
}

TEST(Explore, AKeyDecidesWhichKeysAMappingBesideItHas) {
  const Outline found = outline_of([](YamlMap& m) {
    for (auto& [name, entry] : m.other_maps()) {
      const int kind = entry.choice<int>("kind", {{"a", 0}, {"b", 1}});
      if (kind == 1) entry.integer("of_b", {0, 1});
      if (auto inner = entry.map_if("inner")) {
        inner->number_or("shared", kind == 0 ? 0.1 : 0.2, {0.0, 1.0});
        inner->number_or(kind == 0 ? "inner_a" : "inner_b", 0.5, {0.0, 1.0});
      }
    }
  });
  EXPECT_THAT(cases(found, "NAME.inner"), ElementsAre("kind: a -> shared? inner_a?", "kind: b -> shared? inner_b?"));
  EXPECT_TRUE(found.find("NAME.inner")->cases[1].conditions[0].around);
  const Key& shared = key_of(found, "NAME.inner", "shared");
  EXPECT_TRUE(shared.default_by.empty()) << "each case has its own";
  EXPECT_EQ(shared.question.fallback, KeyValue(0.1));
}

TEST(Explore, AKeyThatIsOnlyRefusedIsNone) {
  const Outline found = outline_of([](YamlMap& m) {
    m.integer("a", {1, 9});
    if (m.has("old")) m.fail("old", "must not be given");
  });
  EXPECT_THAT(cases(found, ""), ElementsAre("-> a"));
}

TEST(Explore, AValueSharedByAllOrOwn) {
  const Outline found = outline_of([](YamlMap& m) {
    YamlMap shared = m.map("shared"), own = m.map("own");
    const bool in_shared = shared.has("v");
    (own.has("v") || !in_shared ? own : shared).integer("v", {0, 3});
  });
  EXPECT_THAT(cases(found, "shared"), ElementsAre("-> v?"));
  EXPECT_THAT(cases(found, "own"), ElementsAre("-> v?"));
}

TEST(Explore, TheSameKeyReadAgainAsATextIsItsWord) {
  outline_of([](YamlMap& m) {
    const int kind = m.choice<int>("kind", {{"a", 0}, {"b", 1}});
    EXPECT_EQ(m.text("kind"), kind == 0 ? "a" : "b");
    EXPECT_TRUE(m.has("kind"));
  });
}

}  // namespace
}  // namespace ttf::keys
