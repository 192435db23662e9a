#include "core/yaml_edit.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/errors.h"
#include "tests/support/refusals.h"

namespace ttf {
namespace {

const std::string kText =
    "# Grüße\n"
    "name: a name   # what it is called\n"
    "world:\n"
    "  noise: 2.0   # stays\n"
    "  objects:\n"
    "    - {name: car, x: 1, period: 40 ms}\n"
    "    - name: other\n"
    "      x: 7\n"
    "quoted: \"2\"\n";

std::string with(std::string_view path, std::string_view value) { return with_value(kText, "a.yaml", path, value); }
std::string refusal(std::string_view path, std::string_view value) {
  return support::refusal_of([&] { (void)with(path, value); }, "taken");
}

std::string replaced(const std::string& what, const std::string& by) {
  std::string text = kText;
  return text.replace(text.find(what), what.size(), by);
}

TEST(YamlEdit, OneScalarIsReplacedAndNothingElse) {
  EXPECT_EQ(with("world.noise", "17.25"), replaced("2.0", "17.25"));
  EXPECT_EQ(with("name", "b"), replaced("a name", "b"));
  EXPECT_EQ(with("world.objects[0].period", "41.5 ms"), replaced("40 ms", "41.5 ms"));
  EXPECT_EQ(with("world.objects[1].x", "-8"), replaced("x: 7", "x: -8"));
  EXPECT_EQ(with("world.noise", "2.0"), kText);
}

TEST(YamlEdit, OnlyWhatIsThereCanBeReplaced) {
  for (const char* path : {"world.speed", "world.objects[2].x", "world.objects[-1].x", "world.objects[x].x", "world[0]",
                           "world.noise.x", "world.objects[0", ""})
    EXPECT_THAT(refusal(path, "1"), testing::AnyOf(testing::HasSubstr("only its written keys can be varied"),
                                                   testing::HasSubstr("must be a plain scalar")))
        << path;
  EXPECT_EQ(refusal("world.speed", "1"),
            "a.yaml: world.speed: must be in the file: only its written keys can be varied");
  EXPECT_EQ(refusal("quoted", "1"), "a.yaml:9: quoted: must be a plain scalar to be varied");
  EXPECT_THAT(refusal("world", "1"), testing::HasSubstr("a.yaml:4: world: must be a plain scalar"));
}

TEST(YamlEdit, AValueStaysAValue) {
  for (const char* value : {"1, y: 2", "{a: 1}", "[1]", "1 # 2", "1\n  y: 2", "", " 1", "&a 1", "*a", "1: 2"})
    EXPECT_THAT(refusal("world.objects[0].x", value), testing::HasSubstr("must be a plain scalar")) << value;
}

std::string added(const std::string& text, const std::string& path, const std::string& value, int at) {
  int line = 0;
  std::string edited = with_key(text, "a.yaml", path, value, &line);
  EXPECT_EQ(line, at) << path;
  return edited;
}

TEST(YamlEdit, AKeyIsAddedInFrontOfItsMappingsFirst) {
  EXPECT_EQ(added(kText, "world.seed", "3", 4), replaced("  noise", "  seed: 3\n  noise"));
  EXPECT_EQ(added(kText, "world.objects[0].speed", "4", 0), replaced("{name", "{speed: 4, name"));
  EXPECT_EQ(added(kText, "world.objects[1].y", "5", 7), replaced("name: other", "y: 5\n      name: other"));
  EXPECT_EQ(added("a: {}\n", "d", "3", 1), "d: 3\na: {}\n");
  EXPECT_EQ(added("a: {}\n", "a.b", "1", 0), "a: {b: 1, }\n");
  EXPECT_EQ(added("a: &anchor {}\n", "a.b", "1", 0), "a: &anchor {b: 1, }\n");
  int line = 0;
  EXPECT_THROW((void)with_key(kText, "a.yaml", "nothing.here", "1", &line), InputError);
}

}  // namespace
}  // namespace ttf
