#include "core/strict_yaml.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace ttf {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

std::vector<std::string> read(const std::string& text, const std::function<void(YamlMap&)>& reader) {
  const StrictYaml yaml = StrictYaml::parse(text, "a.yaml");
  Findings findings;
  YamlMap root = yaml.root(findings);
  reader(root);
  root.finish();
  std::vector<std::string> sentences;
  for (const Finding& finding : findings.list()) sentences.push_back(finding.sentence());
  return sentences;
}

TEST(StrictYaml, ReadsWhatIsThere) {
  const auto sentences = read("n: 3\nx: 0.5\nflag: true\nname: fusion\nwait: 2.5 us\nmode: fast\nmicrotick: 12.5\nlist: [1, 2]\n",
                              [](YamlMap& map) {
                                EXPECT_EQ(map.integer("n", {0, 5}), 3);
                                EXPECT_DOUBLE_EQ(map.number("x", {0, 1}), 0.5);
                                EXPECT_TRUE(map.boolean("flag"));
                                EXPECT_EQ(map.text("name"), "fusion");
                                EXPECT_EQ(map.duration("wait", {Duration{}, Duration::milliseconds(1)}).ns, 2500);
                                EXPECT_EQ(map.choice<int>("mode", {{"slow", 1}, {"fast", 2}}), 2);
                                EXPECT_EQ(map.scaled("microtick", 1000, {12'500, 50'000}), 12'500);
                                EXPECT_THAT(map.numbers("list", {0, 9}, {1, 3}), ElementsAre(1, 2));
                                EXPECT_EQ(map.integer_or("absent", 7, {0, 9}), 7);
                              });
  EXPECT_TRUE(sentences.empty()) << testing::PrintToString(sentences);
}

TEST(StrictYaml, OutOfRangeNamesFileLineKeyValueAndRange) {
  EXPECT_THAT(read("a: 1\nn: 900\n",
                   [](YamlMap& map) {
                     map.integer("a", {0, 5});
                     map.integer("n", {2, 805}, "macroticks");
                   }),
              ElementsAre("a.yaml:2: n = 900: must be a whole number 2..805 macroticks"));
}

TEST(StrictYaml, ReportsEverythingAtOnce) {
  const auto sentences = read("n: many\ntwice: 1\ntwice: 2\nunknown: 3\ninner: {x: 1, y: 2}\nlate: 3 hours\n",
                              [](YamlMap& map) {
                                map.integer("n", {0, 5});
                                map.integer("twice", {0, 5});
                                map.integer("missing", {0, 5});
                                YamlMap inner = map.map("inner");
                                inner.integer("x", {0, 5});
                                inner.finish();
                                map.duration("late", {Duration{}, Duration::milliseconds(5)});
                              });
  EXPECT_THAT(sentences, ElementsAre(HasSubstr("a.yaml:1: n = many"), HasSubstr("missing: is missing"),
                                     HasSubstr("a.yaml:5: inner.y: is not a known key"),
                                     HasSubstr("a.yaml:6: late = 3 hours"), HasSubstr("a.yaml:3: twice: is given twice"),
                                     HasSubstr("a.yaml:4: unknown: is not a known key")));
}

TEST(StrictYaml, BrokenYamlAndMissingFilesAreOneSentence) {
  const auto sentence_of = [](const std::function<void()>& action) -> std::string {
    try {
      action();
    } catch (const InputError& error) {
      EXPECT_EQ(error.findings().size(), 1u);
      return error.what();
    }
    return "nothing was thrown";
  };
  EXPECT_THAT(sentence_of([] { StrictYaml::parse("a: [1, 2\nb: 3\n", "b.yaml"); }), HasSubstr("b.yaml:"));
  EXPECT_THAT(sentence_of([] { StrictYaml::parse("- 1\n", "b.yaml"); }), HasSubstr("must be a YAML mapping"));
  EXPECT_THAT(sentence_of([] { StrictYaml::load("no/such.yaml"); }), HasSubstr("no/such.yaml: cannot be read"));
}

TEST(StrictYaml, OneDocumentToItsEnd) {
  const auto sentence_of = [](const std::string& text) -> std::string {
    try {
      StrictYaml::parse(text, "c.yaml");
    } catch (const InputError& error) {
      return error.what();
    }
    return "accepted";
  };
  EXPECT_EQ(sentence_of("a: 1\n...\n"), "accepted");
  EXPECT_EQ(sentence_of("---\na: 1\t# tabs and line ends are fine\r\n"), "accepted");
  EXPECT_EQ(sentence_of("a: 1\n---\nb: 2\n"), "c.yaml:2: must be one YAML document: another one begins here");
  // The parser sees documents of nothing here, and never the end of them.
  EXPECT_EQ(sentence_of(", "), "c.yaml:1: must be one YAML document: another one begins here");
  // The parser takes this character for the end of the file.
  EXPECT_EQ(sentence_of("a: 1\n\x04\nb: 2\n"), "c.yaml:2: byte 0x04: must not be in a YAML text");
  EXPECT_EQ(sentence_of(std::string("a: 1\0b", 6)), "c.yaml:1: byte 0x00: must not be in a YAML text");
}

TEST(StrictYaml, SentencesStayOneLineWhateverTheInput) {
  const auto sentences = read("n: |\n  two\n  lines\nm: \"" + std::string(5000, 'x') + "\"\n? \"new\\nline\"\n: 1\n",
                              [](YamlMap& map) {
                                map.integer("n", {0, 5});
                                map.integer("m", {0, 5});
                              });
  EXPECT_THAT(sentences, ElementsAre(HasSubstr("n = two\\x0alines\\x0a: must be"),
                                     HasSubstr("m = " + std::string(100, 'x') + "...: must be"),
                                     HasSubstr("new\\x0aline: is not a known key")));
}

TEST(StrictYaml, ScaledNumbersAreExact) {
  const auto value = [](const std::string& text) {
    std::int64_t result = -1;
    read("v: " + text + "\n", [&](YamlMap& map) { result = map.scaled("v", 1'000'000, {-5'000'000'000, 5'000'000'000}); });
    return result;
  };
  EXPECT_EQ(value("1.375"), 1'375'000);
  EXPECT_EQ(value("-0.000001"), -1);
  EXPECT_EQ(value("4999.999999"), 4'999'999'999);
  EXPECT_EQ(value("0.0000001"), -5'000'000'000) << "finer than the scale: a finding, and the lower bound";
}

}  // namespace
}  // namespace ttf
