#include "core/yaml_merge.h"

#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include <nlohmann/json.hpp>
#include <random>

#include "core/errors.h"

namespace ttf {
namespace {

std::string merged(const std::string& low, const std::string& high) {
  return merge_yaml({{low, "low.yaml"}, {high, "high.yaml"}}, "extends").text;
}

std::string merge_refusal(const std::string& low, const std::string& high) {
  try {
    return merged(low, high);
  } catch (const InputError& error) {
    return error.what();
  }
}

TEST(YamlMerge, MappingsAreChangedKeyByKey) {
  EXPECT_EQ(merged("a: 1\nb: {c: 2, d: 3}\n", "extends: low.yaml\nb: {d: 4}\n"), "a: 1\nb:\n  c: 2\n  d: 4\n");
  EXPECT_EQ(merged("a: {b: {c: 1, d: {e: 2}}}\n", "a: {b: {d: {e: 3}}}\n"), "a:\n  b:\n    c: 1\n    d:\n      e: 3\n");
}

TEST(YamlMerge, AListTakesThePlaceOfTheWholeList) {
  EXPECT_EQ(merged("a: [1, 2, 3]\nb: [{c: 1}]\n", "a: [4]\n"), "a: [4]\nb: [{c: 1}]\n");
  EXPECT_EQ(merged("a: [1, 2]\n", "a: {b: 1}\n"), "a: {b: 1}\n");
  EXPECT_EQ(merged("a: {b: 1}\n", "a: word\n"), "a: word\n");
}

TEST(YamlMerge, ATildeRemoves) {
  EXPECT_EQ(merged("a: 1\nb: {c: 2, d: 3}\n", "a: ~\nb: {c: ~}\n"), "b:\n  d: 3\n");
  EXPECT_EQ(merged("a: {b: 1}\nc: 2\n", "a: {b: ~}\n"), "a: {}\nc: 2\n");
}

TEST(YamlMerge, ANewKeyFollowsTheKeyBeforeItInItsOwnText) {
  EXPECT_EQ(merged("a: 1\nb: 2\nc: 3\n", "b: 2\nx: 4\ny: 5\n"), "a: 1\nb: 2\nx: 4\ny: 5\nc: 3\n");
  EXPECT_EQ(merged("a: 1\nb: 2\nc: 3\n", "a: ~\nx: 4\ny: 5\nc: 6\n"), "b: 2\nx: 4\ny: 5\nc: 6\n");
  EXPECT_EQ(merged("a: 1\nb: 2\n", "a: ~\nx: 4\n"), "b: 2\nx: 4\n");
  EXPECT_EQ(merged("n:\n  a: {p: 1}\n  b: {p: 2}\n", "n: {a: {}, x: {p: 3}}\n"),
            "n:\n  a: {p: 1}\n  x: {p: 3}\n  b: {p: 2}\n");
}

TEST(YamlMerge, LinesHaveTheirFile) {
  const MergedYaml all = merge_yaml({{"a: 1\nb:\n  c: 2\n  l:\n    - {x: 1}\n    - y: 2\n      z: 3\n", "low.yaml"},
                                     {"# words\nb:\n  c: 4\n  d: 5\n", "high.yaml"}},
                                    "extends");
  EXPECT_EQ(all.text, "a: 1\nb:\n  c: 4\n  d: 5\n  l:\n    - {x: 1}\n    - y: 2\n      z: 3\n");
  const auto at = [&](int line) {
    const TextPlace place = all.origins.place("high.yaml", line);
    return place.file + ":" + std::to_string(place.line);
  };
  EXPECT_EQ(at(1), "low.yaml:1");
  EXPECT_EQ(at(2), "low.yaml:2");
  EXPECT_EQ(at(3), "high.yaml:3");
  EXPECT_EQ(at(4), "high.yaml:4");
  EXPECT_EQ(at(5), "low.yaml:4");
  EXPECT_EQ(at(6), "low.yaml:5");
  EXPECT_EQ(at(7), "low.yaml:6");
  EXPECT_EQ(at(8), "low.yaml:7");
  EXPECT_EQ(at(0), "high.yaml:0");
}

TEST(YamlMerge, MistakesAreNamedWithTheirFileAndLine) {
  EXPECT_EQ(merge_refusal("a: 1\n", "b: ~\n"), "high.yaml:1: b = ~: must be in the file below, for ~ to remove it");
  EXPECT_EQ(merge_refusal("a: 1\n", "b: {c: {d: ~}}\n"),
            "high.yaml:1: b.c.d = ~: must be in the file below, for ~ to remove it");
  EXPECT_EQ(merge_refusal("a: 1\na: 2\n", "b: 1\n"), "low.yaml:2: a: is given twice in one mapping");
  EXPECT_EQ(merge_refusal("a: 1\n", "l: [{c: 1, c: 2}]\n"), "high.yaml:1: l[0].c: is given twice in one mapping");
  EXPECT_EQ(merge_refusal("a: 1\n", "[1]: 2\n"), "high.yaml:1: has a key that is not a plain text");
  EXPECT_EQ(merge_refusal("a: 1\n", "- 1\n"), "high.yaml:1: must be a YAML mapping at the top level");
}

TEST(YamlMerge, AliasesThatNestForeverOrGrowWithoutEndAreRefused) {
  EXPECT_NE(merge_refusal("a: 1\n", "b: &x [*x]\n").find("must not nest deeper than 32 levels"), std::string::npos);
  std::string bomb = "k0: &k0 [1, 1, 1, 1, 1, 1, 1, 1, 1, 1]\n";
  for (int i = 1; i < 8; ++i) {
    bomb += "k" + std::to_string(i) + ": &k" + std::to_string(i) + " [";
    for (int j = 0; j < 10; ++j) bomb += (j ? ", *k" : "*k") + std::to_string(i - 1);
    bomb += "]\n";
  }
  EXPECT_NE(merge_refusal("a: 1\n", bomb).find("must not have more than 1000000 values"), std::string::npos);
}

TEST(YamlMerge, ScalarsKeepTheirText) {
  for (const std::string text :
       {"",  "~",   "null", "a b", " a", "a ",   "a: b",   "a #b", "-",    "-1.5", "- a", "'", "\"", "\\", "ä",
        "{", "[x]", "*a",   "&a",  "!t", "a\nb", "0.5 ms", "true", "1e-3", "?",    "|",   "%", "@",  ",",  "a,b"}) {
    const YAML::Node node = YAML::Load("k: " + yaml_scalar(text) + "\nl: [" + yaml_scalar(text) + "]\n");
    ASSERT_TRUE(node["k"].IsScalar()) << text;
    EXPECT_EQ(node["k"].Scalar(), text);
    EXPECT_EQ(node["l"][0].Scalar(), text);
  }
}

// Drawn documents, in JSON: nlohmann's merge_patch() is another implementation of RFC 7396.
class Draw {
 public:
  explicit Draw(std::uint64_t seed) : random_(seed) {}
  nlohmann::json value(int depth) {
    const auto kind = below(depth > 3 ? 1 : 3);
    if (kind == 0) return std::to_string(below(100));
    if (kind == 1) {
      nlohmann::json list = nlohmann::json::array();
      for (auto n = below(3); n > 0; --n) list.push_back(depth > 3 ? nlohmann::json("x") : value(depth + 1));
      return list;
    }
    return map(depth + 1);
  }
  nlohmann::json map(int depth) {
    nlohmann::json object = nlohmann::json::object();
    for (auto n = below(5); n > 0; --n) object["k" + std::to_string(below(6))] = value(depth + 1);
    return object;
  }
  // Nulls only where there is something to remove.
  nlohmann::json patch(const nlohmann::json& base, int depth) {
    nlohmann::json object = map(depth);
    for (const auto& [key, value] : base.items()) {
      const auto what = below(4);
      if (what == 0) object[key] = nullptr;
      if (what == 1 && value.is_object()) object[key] = patch(value, depth + 1);
    }
    return object;
  }

 private:
  std::uint64_t below(std::uint64_t n) { return random_() % n; }
  std::mt19937_64 random_;
};

nlohmann::json as_json(const YAML::Node& node) {
  if (node.IsScalar()) return node.Scalar();
  nlohmann::json made = node.IsMap() ? nlohmann::json::object() : nlohmann::json::array();
  for (const auto& one : node)
    if (node.IsMap())
      made[one.first.Scalar()] = as_json(one.second);
    else
      made.push_back(as_json(one));
  return made;
}

TEST(YamlMerge, AgreesWithAnotherImplementationOfRfc7396) {
  Draw draw(7396);
  int changed = 0;
  for (int i = 0; i < 2000; ++i) {
    nlohmann::json base = draw.map(0);
    const nlohmann::json patch = draw.patch(base, 0);
    if (base.empty() || patch.empty()) continue;
    // Indented texts are on many lines, others on one.
    const std::string text = merged(base.dump(i % 3 == 0 ? 2 : -1), patch.dump(i % 2 == 0 ? 2 : -1));
    const nlohmann::json before = base;
    base.merge_patch(patch);
    changed += base != before ? 1 : 0;
    if (base.empty()) continue;
    EXPECT_EQ(as_json(YAML::Load(text)), base) << before << "\n" << patch << "\n" << text;
  }
  EXPECT_GT(changed, 1000);
}

// All kinds of scalars, keys and nesting mean the same when they are written anew.
TEST(YamlMerge, AValueStaysWhatItIsInEveryStyle) {
  for (const std::string text :
       {"a: |\n  two\n  lines\nb: >-\n  folded\n  text\n", "a: 'it''s'\nb: \"tab\\t\\u00e4 \\\" \\\\\"\n",
        "a: [1, [2, {b: 3, c: [ ]}], {}]\n", "a:\n- b\n-\n  - c\n  - d: 1\n    e:\n    - 2\n",
        "a: \"- x\"\nb: '? y'\nc: '& z'\nd: '!t'\ne: 'a: b'\nf: 'a #b'\ng: '@x'\n", "'a b': 1\n'c: d': 2\n\"\": 3\n",
        "a: 'true'\nb: '~'\nc: ''\nd: 'null'\ne: -5\nf: -.5\ng: 1e-3\nh: '...'\n",
        "a: &x [1,\n 2]\nb: *x\nc: {d: *x}\n", "a: {b: 1,\n  c: 2}\n'---': äöü\n",
        "a: 'x\n\n  y'\nb: ' x '\nc: \"\\x01\"\n"}) {
    YAML::Node again = YAML::Load(merged(text, "z: 1\n"));
    again.remove("z");
    EXPECT_EQ(as_json(again), as_json(YAML::Load(text))) << text;
  }
}

}  // namespace
}  // namespace ttf
