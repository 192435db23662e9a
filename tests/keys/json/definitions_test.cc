// A schema with its repetitions in `$defs` means the same as before, and is written in the same way each time.
#include "keys/json/definitions.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>
#include <string>

namespace ttf::keys::json {
namespace {

const std::string kLong(kWidth, 'x');

Json described(const std::string& words) { return {{"type", "string"}, {"description", words + kLong}}; }

Json mapping(Json properties) { return {{"type", "object"}, {"properties", std::move(properties)}}; }

// Returns the schema with each reference replaced by its definition.
Json resolved(const Json& value, const Json& definitions) {
  if (value.is_object() && value.contains("$ref")) {
    const std::string name = value["$ref"].get<std::string>().substr(std::string("#/$defs/").size());
    return resolved(definitions.at(name), definitions);
  }
  Json out = value;
  if (out.is_structured())
    for (auto& inner : out) inner = resolved(inner, definitions);
  return out;
}

Json without_definitions(Json schema) {
  const Json definitions = schema.value("$defs", Json::object());
  schema.erase("$defs");
  return resolved(schema, definitions);
}

TEST(Definitions, EqualSchemasStandOnceUnderTheNameOfTheFirstProperty) {
  const Json schema = with_definitions(mapping({{"left", described("a")}, {"right", described("a")}}));
  EXPECT_EQ(schema["properties"]["left"], (Json{{"$ref", "#/$defs/left"}}));
  EXPECT_EQ(schema["properties"]["right"], (Json{{"$ref", "#/$defs/left"}}));
  EXPECT_EQ(schema["$defs"], (Json{{"left", described("a")}}));
}

TEST(Definitions, DifferentSchemasOfOneNameHaveNumbers) {
  const Json one = mapping({{"speed", described("a")}}), other = mapping({{"speed", described("b")}});
  const Json schema = with_definitions(
      mapping({{"p", one}, {"q", mapping({{"inner", one}})}, {"r", other}, {"s", mapping({{"inner", other}})}}));
  EXPECT_TRUE(schema["$defs"].contains("p"));
  EXPECT_TRUE(schema["$defs"].contains("r"));
  const Json speeds = with_definitions(mapping({{"a", mapping({{"speed", described("a")}, {"x", described("x")}})},
                                                {"b", mapping({{"speed", described("b")}, {"x", described("y")}})},
                                                {"c", mapping({{"speed", described("a")}, {"x", described("z")}})},
                                                {"d", mapping({{"speed", described("b")}, {"x", described("w")}})}}));
  EXPECT_EQ(speeds["$defs"]["speed"], described("a"));
  EXPECT_EQ(speeds["$defs"]["speed_2"], described("b"));
}

TEST(Definitions, TheMeaningStays) {
  const Json leaf = described("leaf"), inner = mapping({{"leaf", leaf}, {"other", described("other")}});
  const Json schema{{"if", {{"required", {"extends"}}}},
                    {"then", mapping({{"inner", inner}, {"list", {{"type", "array"}, {"items", inner}}}})},
                    {"else", mapping({{"leaf", leaf}, {"named", {{"patternProperties", {{"^.", inner}}}}}})}};
  const Json shorter = with_definitions(schema);
  EXPECT_LT(text_of(shorter).size(), text_of(schema).size());
  EXPECT_EQ(without_definitions(shorter), schema);
  EXPECT_EQ(text_of(with_definitions(schema)), text_of(shorter));
}

TEST(Definitions, ASchemaThatFitsOnALineStays) {
  const Json schema = mapping({{"a", {{"type", "string"}}}, {"b", {{"type", "string"}}}});
  EXPECT_EQ(with_definitions(schema), schema);
}

TEST(Text, NoLineIsLongerThanItsWidthWhereItCanBeDivided) {
  const Json schema = mapping({{"words", {{"enum", Json::array()}}}, {"text", described("")}});
  Json many = schema;
  for (int i = 0; i < 60; ++i) many["properties"]["words"]["enum"].push_back("word_" + std::to_string(i));
  const std::string text = text_of(many);
  EXPECT_EQ(Json::parse(text), many);
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);)
    EXPECT_TRUE(line.size() <= kWidth || line.find(kLong) != std::string::npos) << line;
}

}  // namespace
}  // namespace ttf::keys::json
