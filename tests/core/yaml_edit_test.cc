#include "core/yaml_edit.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/errors.h"

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
  try {
    (void)with(path, value);
  } catch (const InputError& error) {
    return error.what();
  }
  return "taken";
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

}  // namespace
}  // namespace ttf
