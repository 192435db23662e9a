#include "core/strict_yaml.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <vector>

#include "tests/support/refusals.h"

namespace ttf {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

std::vector<std::string> read(const std::string& text, const std::function<void(ttf::YamlMap&)>& reader) {
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
  const auto sentences =
      read("n: 3\nx: 0.5\nflag: true\nname: fusion\nwait: 2.5 us\nmode: fast\nmicrotick: 12.5\n", [](YamlMap& map) {
        EXPECT_EQ(map.integer("n", {0, 5}), 3);
        EXPECT_DOUBLE_EQ(map.number("x", {0, 1}), 0.5);
        EXPECT_TRUE(map.boolean("flag"));
        EXPECT_EQ(map.text("name"), "fusion");
        EXPECT_EQ(map.duration("wait", {Duration{}, Duration::milliseconds(1)}).ns, 2500);
        EXPECT_EQ(map.choice<int>("mode", {{"slow", 1}, {"fast", 2}}), 2);
        EXPECT_EQ(map.scaled("microtick", 1000, {12'500, 50'000}), 12'500);
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
  const auto sentences =
      read("n: many\ntwice: 1\ntwice: 2\nunknown: 3\ninner: {x: 1, y: 2}\nlate: 3 hours\n", [](YamlMap& map) {
        map.integer("n", {0, 5});
        map.integer("twice", {0, 5});
        map.integer("missing", {0, 5});
        YamlMap inner = map.map("inner");
        inner.integer("x", {0, 5});
        inner.finish();
        map.duration("late", {Duration{}, Duration::milliseconds(5)});
      });
  EXPECT_THAT(
      sentences,
      ElementsAre(HasSubstr("a.yaml:1: n = many"), HasSubstr("missing: is missing"),
                  HasSubstr("a.yaml:5: inner.y: is not a known key"), HasSubstr("a.yaml:6: late = 3 hours"),
                  HasSubstr("a.yaml:3: twice: is given twice"), HasSubstr("a.yaml:4: unknown: is not a known key")));
}

TEST(StrictYaml, AKeyOfEarlierVersionsIsRefusedWithWhatStandsForIt) {
  const auto keys = [](YamlMap& map) {
    map.integer("known", {0, 5});
    map.gone("old", "`known` stands for it");
  };
  EXPECT_THAT(read("known: 1\n", keys), ElementsAre());
  EXPECT_THAT(read("known: 1\nold: 2\n", keys),
              ElementsAre("a.yaml:2: old = 2: is no key any longer: `known` stands for it"));
  EXPECT_THAT(read("known: 1\nodd: 2\n", keys), ElementsAre("a.yaml:2: odd: is not a known key here (known: known)"));
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
    return support::refusal_of([&] { StrictYaml::parse(text, "c.yaml"); }, "accepted");
  };
  EXPECT_EQ(sentence_of("a: 1\n...\n"), "accepted");
  EXPECT_EQ(sentence_of("---\na: 1\t# tabs and line ends are fine\r\n"), "accepted");
  EXPECT_EQ(sentence_of("a: 1\n---\nb: 2\n"), "c.yaml:2: must be one YAML document: another one begins here");
  EXPECT_EQ(sentence_of("# x\na: 1\n...\nb: 2\n"), "c.yaml:4: must be one YAML document: another one begins here");
  // Mappings that end without a mark.
  EXPECT_EQ(sentence_of("!t\n  a: 1\nb: 2\n"), "c.yaml:3: must be one YAML document: another one begins here");
  EXPECT_EQ(sentence_of("{a: 1}\nb: 2\n"), "c.yaml:2: must be one YAML document: another one begins here");
  EXPECT_EQ(sentence_of(" a: 1\nb: 2\n"), "c.yaml:2: must be one YAML document: another one begins here");
  // Here the parser sees empty documents without end.
  EXPECT_EQ(sentence_of(", "), "c.yaml:1: must be one YAML document: another one begins here");
  // The parser takes this character for the end of the file.
  EXPECT_EQ(sentence_of("a: 1\n\x04\nb: 2\n"), "c.yaml:2: byte 0x04: must not be in a YAML text");
  EXPECT_EQ(sentence_of(std::string("a: 1\0b", 6)), "c.yaml:1: byte 0x00: must not be in a YAML text");
}

TEST(StrictYaml, SentencesStayOneLineWhateverTheInput) {
  const auto sentences =
      read("n: |\n  two\n  lines\nm: \"" + std::string(5000, 'x') + "\"\n? \"new\\nline\"\n: 1\n", [](YamlMap& map) {
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
    read("v: " + text + "\n", [&](YamlMap& map) {
      result = map.scaled("v", 1'000'000, {-5'000'000'000, 5'000'000'000});
    });
    return result;
  };
  EXPECT_EQ(value("1.375"), 1'375'000);
  EXPECT_EQ(value("-0.000001"), -1);
  EXPECT_EQ(value("4999.999999"), 4'999'999'999);
  EXPECT_EQ(value("0.0000001"), -5'000'000'000) << "finer than the scale: a finding, and the lower bound";
}

// Each getter's result without a usable value, and its sentence.
struct Refusal {
  const char* text;
  std::function<void(ttf::YamlMap&)> read;
  const char* sentence;
};

TEST(StrictYaml, EachGetterNamesWhatItWants) {
  const Range<Duration> kTimes{Duration::microseconds(1), Duration::milliseconds(20)};
  const std::vector<Refusal> refusals{
      {"v: 3.0",
       [](YamlMap& m) {
         EXPECT_EQ(m.integer("v", {1, 5}), 1);
       },
       "a.yaml:1: v = 3.0: must be a whole number 1..5"},
      {"v: 99999999999999999999",
       [](YamlMap& m) {
         EXPECT_EQ(m.integer("v", {1, 5}), 1);
       },
       "a.yaml:1: v = 99999999999999999999: must be a whole number 1..5"},
      {"v: [1]",
       [](YamlMap& m) {
         EXPECT_EQ(m.integer("v", {1, 5}), 1);
       },
       "a.yaml:1: v: must be a whole number 1..5"},
      {"v: 6",
       [](YamlMap& m) {
         EXPECT_EQ(m.integer_or("v", 3, {1, 5}), 1);
       },
       "a.yaml:1: v = 6: must be a whole number 1..5"},
      {"v: nan",
       [](YamlMap& m) {
         EXPECT_EQ(m.number("v", {0.5, 1.5}, "m"), 0.5);
       },
       "a.yaml:1: v = nan: must be a number 0.5..1.5 m"},
      {"v: 1.5m",
       [](YamlMap& m) {
         EXPECT_EQ(m.number_or("v", 1.0, {0.5, 1.5}), 0.5);
       },
       "a.yaml:1: v = 1.5m: must be a number 0.5..1.5"},
      {"v: 12.50005",
       [](YamlMap& m) {
         EXPECT_EQ(m.scaled("v", 1000, {12'500, 50'000}, "ns"), 12'500);
       },
       "a.yaml:1: v = 12.50005: must be a decimal number 12.5..50 ns, in steps of 0.001"},
      {"v: 1e1",
       [](YamlMap& m) {
         EXPECT_EQ(m.scaled("v", 1000, {0, 50'000}), 0);
       },
       "a.yaml:1: v = 1e1: must be a decimal number 0..50, in steps of 0.001"},
      {"v: 1.2.3",
       [](YamlMap& m) {
         EXPECT_EQ(m.scaled("v", 1000, {0, 50'000}), 0);
       },
       "in steps of 0.001"},
      {"v: '-'",
       [](YamlMap& m) {
         EXPECT_EQ(m.scaled("v", 1000, {0, 50'000}), 0);
       },
       "in steps of 0.001"},
      {"v: 9223372036854775807",
       [](YamlMap& m) {
         EXPECT_EQ(m.scaled("v", 1000, {0, 50'000}), 0);
       },
       "in steps of 0.001"},
      {"v: yes", [](YamlMap& m) { EXPECT_FALSE(m.boolean("v")); }, "a.yaml:1: v = yes: must be true or false"},
      {"v: ''", [](YamlMap& m) { EXPECT_EQ(m.text("v"), ""); }, "a.yaml:1: v: must be a text"},
      {"v: {a: 1}", [](YamlMap& m) { EXPECT_EQ(m.text_or("v", "x"), ""); }, "a.yaml:1: v: must be a text"},
      {"v: 5", [&](YamlMap& m) { EXPECT_EQ(m.duration("v", kTimes), kTimes.low); },
       "a.yaml:1: v = 5: must be a time with its unit (ns, us, ms or s), 1 us..20 ms"},
      {"v: 1.5 ns", [&](YamlMap& m) { EXPECT_EQ(m.duration("v", kTimes), kTimes.low); }, "v = 1.5 ns: must be a time"},
      {"v: 21 ms", [&](YamlMap& m) { EXPECT_EQ(m.duration_or("v", kTimes.high, kTimes), kTimes.low); },
       "v = 21 ms: must"},
      {"v: medium",
       [](YamlMap& m) {
         EXPECT_EQ(m.choice<int>("v", {{"slow", 1}, {"fast", 2}}), 1);
       },
       "a.yaml:1: v = medium: must be one of slow, fast"},
      {"v: 3", [](YamlMap& m) { m.map("v").finish(); }, "a.yaml:1: v = 3: must be a mapping"},
      {"v: 3", [](YamlMap& m) { EXPECT_FALSE(m.map_or_word("v", "all", "must be all, or a mapping")); },
       "a.yaml:1: v = 3: must be all, or a mapping"},
      {"v: [all]", [](YamlMap& m) { EXPECT_FALSE(m.map_or_word("v", "all", "must be all, or a mapping")); },
       "a.yaml:1: v: must be all, or a mapping"},
      {"v: {a: 1}", [](YamlMap& m) { EXPECT_TRUE(m.maps("v").empty()); }, "a.yaml:1: v: must be a list of mappings"},
      {"v:\n  - 7", [](YamlMap& m) { EXPECT_TRUE(m.maps_if("v").empty()); }, "a.yaml:2: v[0]: must be a mapping"},
      {"v: a", [](YamlMap& m) { EXPECT_TRUE(m.texts("v").empty()); },
       "a.yaml:1: v = a: must be a list with at least one"},
      {"v: []", [](YamlMap& m) { EXPECT_TRUE(m.texts("v").empty()); }, "a.yaml:1: v: must be a list with at least one"},
      {"v:\n  - a\n  - [b]", [](YamlMap& m) { EXPECT_THAT(m.texts("v"), ElementsAre("a")); },
       "a.yaml:3: v[1]: must be a plain value"},
      {"v:\n  - 1\n  - 6\n  - 5",
       [](YamlMap& m) {
         EXPECT_THAT(m.integers("v", {1, 5}, "m"), ElementsAre(1, 5));
       },
       "a.yaml:3: v[1] = 6: must be a whole number 1..5 m"},
      {"v:\n  - fast\n  - medium",
       [](YamlMap& m) {
         EXPECT_THAT(m.words("v", {"slow", "fast"}), ElementsAre("fast"));
       },
       "a.yaml:3: v[1] = medium: must be one of slow, fast"},
      {"v:\n  a: 7", [](YamlMap& m) { EXPECT_TRUE(m.named_maps("v").empty()); }, "a.yaml:2: v.a: must be a mapping"},
      {"v: 1\na: 7",
       [](YamlMap& m) {
         EXPECT_EQ(m.integer("v", {0, 5}), 1);
         EXPECT_TRUE(m.other_maps().empty());
       },
       "a.yaml:2: a: must be a mapping"},
      {"v:\n  a: {b: 1}", [](YamlMap& m) { EXPECT_TRUE(m.named_texts("v").empty()); }, "a.yaml:2: v.a: must be a text"},
      {"v:\n  a: x\n  a: y", [](YamlMap& m) { EXPECT_EQ(m.named_texts("v").size(), 2u); },
       "a.yaml:3: v.a: is given twice in one mapping"},
      {"v: 1\n? [a, b]\n: 2",
       [](YamlMap& m) {
         EXPECT_EQ(m.integer("v", {0, 5}), 1);
       },
       "a.yaml:2: has a key that is not a plain text"},
  };
  for (const Refusal& refusal : refusals) {
    SCOPED_TRACE(refusal.text);
    EXPECT_THAT(read(refusal.text, refusal.read), ElementsAre(HasSubstr(refusal.sentence)));
  }
}

TEST(StrictYaml, MissingKeysAreNamedWithTheirRanges) {
  EXPECT_THAT(read("other:\n  a: 1\n",
                   [](YamlMap& map) {
                     YamlMap other = map.map("other");
                     EXPECT_EQ(other.integer("a", {0, 5}), 1);
                     EXPECT_FALSE(other.boolean("b"));
                     EXPECT_TRUE(other.maps("e").empty());
                     EXPECT_FALSE(other.map_if("f").has_value());
                     EXPECT_TRUE(other.maps_if("g").empty());
                     other.finish();
                     // An absent mapping reads as empty; its missing keys are reported at its proper place.
                     YamlMap gone = map.map("gone");
                     EXPECT_EQ(gone.integer("x", {3, 5}), 3);
                     EXPECT_EQ(gone.integer_or("y", 4, {3, 5}), 4);
                     gone.finish();
                   }),
              ElementsAre("a.yaml:2: other.b: is missing: must be true or false",
                          "a.yaml:2: other.e: is missing: must be a list of mappings",
                          "a.yaml:1: gone: is missing: must be a mapping",
                          "a.yaml:1: gone.x: is missing: must be a whole number 3..5"));
}

TEST(StrictYaml, FallbacksStandForWhatIsAbsentOnly) {
  const auto sentences = read(
      "n: 2\nx: 0.5\nflag: true\nname: a\nwait: 3 ms\nmode: fast\nlist: [{v: 1}, {v: 2}]\n"
      "named: {b: {v: 3}, a: {v: 4}}\n",
      [](YamlMap& map) {
        const Range<Duration> times{Duration{}, Duration::milliseconds(20)};
        EXPECT_EQ(map.integer_or("n", 1, {0, 5}), 2);
        EXPECT_EQ(map.number_or("x", 0.1, {0, 1}), 0.5);
        EXPECT_EQ(map.number_or("y", 0.1, {0, 1}), 0.1);
        EXPECT_TRUE(map.boolean_or("flag", false));
        EXPECT_TRUE(map.boolean_or("no_flag", true));
        EXPECT_EQ(map.text_or("name", "b"), "a");
        EXPECT_EQ(map.text_or("no_name", "b"), "b");
        EXPECT_EQ(map.duration_or("wait", {}, times), Duration::milliseconds(3));
        EXPECT_EQ(map.duration_or("no_wait", {}, times), Duration{});
        EXPECT_EQ(map.choice_or<int>("mode", 7, {{"slow", 1}, {"fast", 2}}), 2);
        EXPECT_EQ(map.choice_or<int>("no_mode", 7, {{"slow", 1}, {"fast", 2}}), 7);
        std::vector<std::int64_t> values;
        for (YamlMap& item : map.maps("list")) values.push_back(item.integer("v", {0, 9}));
        for (auto& [name, item] : map.named_maps("named")) {
          values.push_back(item.integer("v", {0, 9}));
          EXPECT_EQ(item.path(), "named." + name);
        }
        EXPECT_THAT(values, ElementsAre(1, 2, 3, 4));  // in file order
      });
  EXPECT_TRUE(sentences.empty()) << testing::PrintToString(sentences);
}

TEST(StrictYaml, OtherMapsAreThoseOfTheNamesNotAskedFor) {
  const auto sentences = read("known: {v: 1}\nb: {v: 2}\na: {w: 3}\n", [](YamlMap& map) {
    EXPECT_TRUE(map.map_if("known"));
    EXPECT_FALSE(map.map_if("unknown"));
    std::vector<std::string> names;
    for (auto& [name, item] : map.other_maps()) {
      names.push_back(name);
      EXPECT_EQ(item.path(), name);
      item.integer_or("v", 0, {0, 9});
      item.finish();
    }
    EXPECT_THAT(names, ElementsAre("b", "a"));
    EXPECT_TRUE(map.other_maps().empty()) << "all were asked for";
  });
  EXPECT_THAT(sentences, ElementsAre(HasSubstr("a.yaml:3: a.w: is not a known key here")));
}

TEST(StrictYaml, AMappingSeparatesItsOwnKeysFromInheritedOnes) {
  const auto sentences = read("a: {x: 1, lik: b}\nb: {y: 9, unread: 3}\n", [](YamlMap& map) {
    YamlMap a = map.map("a"), b = map.map("b");
    a.inherit(b);
    EXPECT_TRUE(a.has_own("x"));
    EXPECT_FALSE(a.has_own("y"));
    EXPECT_EQ(a.integer("x", {0, 9}) + a.integer("y", {0, 9}), 10);
    EXPECT_THAT(a.inherited(), ElementsAre("y"));
    EXPECT_TRUE(a.refuse_misspelt("like"));
    EXPECT_FALSE(a.refuse_misspelt("x")) << "it is there";
    EXPECT_FALSE(b.refuse_misspelt("like"));
    a.finish();
  });
  EXPECT_THAT(sentences, ElementsAre("a.yaml:1: a.lik = b: is not a known key here; did you mean like?"));
}

TEST(StrictYaml, AValueIsShownOnOneLine) {
  const auto sentences = read("a: b\nl: [a, {b: 1}]\nm: {c: [d]}\ne: ''\nn:\n", [](YamlMap& map) {
    std::vector<std::string> values;
    for (const char* key : {"a", "l", "m", "e", "n", "absent"}) values.push_back(map.value_text(key));
    EXPECT_THAT(values, ElementsAre("b", "[a, {b: 1}]", "{c: [d]}", "\"\"", "~", ""));
    map.fail("l", "is a list", map.value_text("l"));
    map.mute();
    map.fail("a", "follows from it");
  });
  EXPECT_THAT(sentences, ElementsAre("a.yaml:2: l = [a, {b: 1}]: is a list"));
}

// Own keys go first. An inherited value has its own line, and no inherited key is unknown.
TEST(StrictYaml, AnInheritedKeyIsThatOfTheOtherMapping) {
  const auto sentences = read("a: {x: 1}\nb: {y: 9, z: 3}\nc: {x: 5, list: [{n: 1}]}\n", [](YamlMap& map) {
    YamlMap a = map.map("a"), b = map.map("b"), c = map.map("c");
    a.inherit(b);
    b.inherit(c);
    EXPECT_EQ(a.integer("x", {0, 9}), 1);
    EXPECT_EQ(a.integer("y", {0, 8}), 0);
    EXPECT_EQ(a.maps("list").size(), 1U);
    EXPECT_FALSE(b.lacks("x"));
    EXPECT_TRUE(c.lacks("y"));
    a.finish();
  });
  EXPECT_THAT(sentences, ElementsAre(HasSubstr("a.yaml:2: a.y = 9: ")));
}

TEST(StrictYaml, TimesAreExactToTheNanosecond) {
  const auto value = [](const std::string& text) {
    Duration result{};
    read("v: " + text + "\n", [&](YamlMap& map) {
      result = map.duration("v", {Duration{-1'000'000'000}, Duration{9'000'000'000'000'000'000}});
    });
    return result.ns;
  };
  EXPECT_EQ(value("100 ns"), 100);
  EXPECT_EQ(value("2.001 us"), 2'001);
  EXPECT_EQ(value("0.000001 ms"), 1);
  EXPECT_EQ(value("1.000000001 s"), 1'000'000'001);
  EXPECT_EQ(value("-0.5 s"), -500'000'000);
  EXPECT_EQ(value("8999999999.999999999 s"), 8'999'999'999'999'999'999);
  EXPECT_EQ(value("3 min"), -1'000'000'000) << "a finding, and the lower bound";
}

}  // namespace
}  // namespace ttf
