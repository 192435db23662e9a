#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "keys/json/definitions.h"
#include "keys/render.h"
#include "keys/rows.h"
#include "keys/value_words.h"

namespace ttf::keys {
namespace {

using json::Json;

// A scalar as YAML has it: a number or a flag where it looks like one.
Json scalar(const std::string& text) {
  const Json value = Json::parse(text, nullptr, false);
  return value.is_number() || value.is_boolean() ? value : Json(text);
}

Json example(const std::string& text) {
  if (!text.starts_with('[')) return scalar(text);
  Json list = Json::array();
  for (std::size_t at = 1; at < text.size();) {
    const std::size_t end = std::min(text.find(',', at), text.size() - 1);
    list.push_back(scalar(text.substr(at, end - at)));
    at = text.find_first_not_of(' ', end + 1);
  }
  return list;
}

Json number(const KeyQuestion& question, const KeyValue& value) {
  if (const double* real = std::get_if<double>(&value)) return *real;
  const std::int64_t whole = std::get<std::int64_t>(value);
  if (question.type != KeyType::kDecimal || whole % question.scale == 0)
    return question.type == KeyType::kDecimal ? whole / question.scale : whole;
  return static_cast<double>(whole) / static_cast<double>(question.scale);
}

Json named(Json entry) {
  return {{"type", "object"}, {"patternProperties", {{"^.", std::move(entry)}}}, {"additionalProperties", false}};
}

// A file with this key changes another one.
constexpr const char* kExtends = "extends";

Json is_alike() { return {{"required", {kLike}}}; }

// A mapping has a schema of its own here. Another value keeps its schema, which then stands once.
Json or_null(Json schema) {
  if (!schema.contains("properties") && !schema.contains("patternProperties"))
    return {{"anyOf", {Json{{"type", "null"}}, std::move(schema)}}};
  schema["type"] = Json::array({"object", "null"});
  return schema;
}

// Returns the schema of a mapping that has other keys elsewhere. No key is required. Keys of all cases are known, since the other
// mapping decides which case it is.
Json lacking(Json schema) {
  schema.erase("required");
  if (!schema.contains("allOf")) return schema;
  for (Json& one : schema["allOf"]) {
    if (!one.contains("then")) continue;
    for (const auto& [key, value] : one["then"]["properties"].items())
      if (!schema["properties"].contains(key)) schema["properties"][key] = true;
    if (one["then"].contains("additionalProperties"))
      schema["additionalProperties"] = one["then"]["additionalProperties"];
    one["then"].erase("additionalProperties");
    one["then"].erase("required");
  }
  return schema;
}

// Returns the schema of a mapping that changes another one: null removes a key. Lists stand for themselves.
Json changing(Json schema) {
  if (!schema.is_object()) return schema;
  if (schema.contains("if") && schema["if"] == is_alike()) return changing(schema["then"]);
  for (const char* of : {"properties", "patternProperties"})
    if (schema.contains(of))
      for (auto& [key, value] : schema[of].items())
        if (value.is_object()) value = or_null(changing(value));
  for (const char* of : {"then", "else"})
    if (schema.contains(of)) schema[of] = changing(schema[of]);
  if (schema.contains("allOf"))
    for (Json& one : schema["allOf"]) one = changing(one);
  return lacking(std::move(schema));
}

class Schema {
 public:
  Schema(const Document& document, const Outline& outline) : document_(document), outline_(outline) {}

  Json whole() const {
    Json schema{{"$schema", "http://json-schema.org/draft-07/schema#"},
                {"title", document_.title},
                {"description", document_.about}};
    const Json own = mapping("");
    const bool extends = own.contains("properties") && own["properties"].contains(kExtends);
    if (!extends) {
      schema.update(own);
      return schema;
    }
    schema["if"] = {{"required", {kExtends}}};
    schema["then"] = changing(own);
    schema["else"] = own;
    return schema;
  }

 private:
  using Cases = std::vector<Case>;

  // `around`: conditions that hold in the mapping around.
  Json mapping(const std::string& path, const std::vector<Condition>& around = {}) const {
    const Mapping* mapping = outline_.find(path);
    if (mapping == nullptr) return {{"type", "object"}};
    const Cases cases = cases_in(*mapping, around);
    if (!may_be_alike(cases)) return mapping_of(cases);
    return {{"if", is_alike()},
            {"then", lacking(mapping_of(cases_with_like(cases, "true")))},
            {"else", mapping_of(cases_with_like(cases, "false"))}};
  }

  static Cases cases_with_like(Cases cases, const char* presence) {
    const auto of_like = [](const Condition& one) { return one.key == kLike && one.of == Condition::Of::kPresence; };
    std::erase_if(cases, [&](const Case& one) {
      return std::any_of(one.conditions.begin(), one.conditions.end(), [&](const Condition& condition) {
        return of_like(condition) && condition.values != std::vector<std::string>{presence};
      });
    });
    for (Case& one : cases) std::erase_if(one.conditions, of_like);
    return cases;
  }

  Json mapping_of(const Cases& cases) const {
    Json schema{{"type", "object"}};
    if (cases.size() == 1) {
      const Case& one = cases.front();
      schema["properties"] = properties(one);
      if (Json needed = required(one); !needed.empty()) schema["required"] = std::move(needed);
      schema["additionalProperties"] = others(one);
      return schema;
    }
    Json common = shared_properties(cases);
    Json everywhere = required_everywhere(cases);
    schema["properties"] = common;
    if (!everywhere.empty()) schema["required"] = everywhere;
    for (const Case& one : cases) {
      Json then{{"properties", properties(one)}};
      for (auto& [key, value] : then["properties"].items())
        if (common.contains(key)) value = true;
      if (Json needed = required(one); needed != everywhere && !needed.empty()) then["required"] = std::move(needed);
      then["additionalProperties"] = others(one);
      schema["allOf"].push_back({{"if", conditions(one)}, {"then", std::move(then)}});
    }
    return schema;
  }

  // The cases that agree with the mapping around.
  static Cases cases_in(const Mapping& mapping, const std::vector<Condition>& around) {
    const auto agrees = [&](const Condition& condition) {
      return !condition.around || std::none_of(around.begin(), around.end(), [&](const Condition& holds) {
        return holds.key == condition.key && holds.of == condition.of && holds.values != condition.values;
      });
    };
    Cases cases;
    for (const Case& one : mapping.cases)
      if (std::all_of(one.conditions.begin(), one.conditions.end(), agrees)) cases.push_back(one);
    return cases;
  }

  Json properties(const Case& one) const {
    Json all = Json::object();
    for (const Key& key : one.keys)
      if (!is_any_name(key)) all[key.question.key] = property(key, one.conditions);
    return all;
  }

  // Returns the schema of all other keys. False refuses them.
  Json others(const Case& one) const {
    for (const Key& key : one.keys)
      if (is_any_name(key)) return property(key, one.conditions);
    return false;
  }

  static bool is_any_name(const Key& key) { return key.question.key == kAnyName; }

  static Json required(const Case& one) {
    Json needed = Json::array();
    for (const Key& key : one.keys)
      if (!key.question.optional) needed.push_back(key.question.key);
    return needed;
  }

  // Keys that are the same in every case that has them: those that decide are among them.
  Json shared_properties(const Cases& cases) const {
    Json shared = Json::object();
    std::set<std::string> different;
    for (const Case& one : cases) {
      const Json all = properties(one);
      for (const auto& [key, value] : all.items()) {
        if (shared.contains(key) && shared[key] != value) different.insert(key);
        shared[key] = value;
      }
    }
    for (const std::string& key : different) shared.erase(key);
    return shared;
  }

  static Json required_everywhere(const Cases& cases) {
    Json everywhere = Json::array();
    for (const Json& key : required(cases.front())) {
      const bool always = std::all_of(cases.begin(), cases.end(), [&](const Case& one) {
        const Json needed = required(one);
        return std::find(needed.begin(), needed.end(), key) != needed.end();
      });
      if (always) everywhere.push_back(key);
    }
    return everywhere;
  }

  static Json conditions(const Case& one) {
    Json all = Json::object();
    const auto require = [&](const std::string& key) {  // once: its presence and its value may both be conditions
      Json& needed = all["required"];
      if (std::find(needed.begin(), needed.end(), Json(key)) == needed.end()) needed.push_back(key);
    };
    for (const Condition& condition : one.conditions) {
      if (condition.around) continue;  // the mapping around decides
      if (condition.of == Condition::Of::kPresence) {
        if (condition.values.size() != 1) continue;
        if (condition.values.front() == "true")
          require(condition.key);
        else
          all["allOf"].push_back({{"not", {{"required", {condition.key}}}}});
        continue;
      }
      Json values = Json::array();
      for (const std::string& value : condition.values) values.push_back(scalar(value));
      all["properties"][condition.key]["enum"] = std::move(values);
      if (!condition.usual) require(condition.key);
    }
    return all;
  }

  Json property(const Key& key, const std::vector<Condition>& conditions) const {
    Json schema = value(key, conditions);
    const Description* description = document_.describe(key.question.path(), conditions);
    annotate(schema, key, description);
    return schema;
  }

  static void annotate(Json& schema, const Key& key, const Description* description) {
    const KeyQuestion& question = key.question;
    if (description != nullptr) {
      std::string words(description->meaning);
      if (question.type == KeyType::kDuration)
        words += fmt::format(" A {}.", value_words(key, ""));
      else if (!question.unit.empty())
        words += fmt::format(" In {}.", question.unit);
      schema["description"] = words;
    }
    if (const auto text = default_text(key)) schema["default"] = scalar(*text);
    if (description != nullptr && !description->example.empty())
      schema["examples"] = Json::array({example(std::string(description->example))});
  }

  Json value(const Key& key, const std::vector<Condition>& around) const {
    const KeyQuestion& question = key.question;
    const Json any_scalar{{"type", {"string", "number", "boolean"}}};
    switch (question.type) {
      case KeyType::kBoolean: return {{"type", "boolean"}};
      case KeyType::kInteger: return numbers("integer", question);
      case KeyType::kNumber:
      case KeyType::kDecimal: return numbers("number", question);
      case KeyType::kDuration:
        return {{"type", "string"},
                {"pattern", std::get<std::int64_t>(question.low) < 0 ? R"(^-?[0-9]+(\.[0-9]+)? (ns|us|ms|s)$)"
                                                                     : R"(^[0-9]+(\.[0-9]+)? (ns|us|ms|s)$)"}};
      case KeyType::kText: return {{"type", {"string", "number", "boolean"}}, {"minLength", 1}};
      case KeyType::kWord: return {{"enum", question.words}};
      case KeyType::kMap:
        if (key.words.empty()) return mapping(question.path(), around);
        return {
            {"if", {{"type", "object"}}}, {"then", mapping(question.path(), around)}, {"else", {{"enum", key.words}}}};
      case KeyType::kMaps: return {{"type", "array"}, {"items", mapping(path_within(question))}};
      case KeyType::kTexts: return {{"type", "array"}, {"minItems", 1}, {"items", any_scalar}};
      case KeyType::kWords: return {{"type", "array"}, {"minItems", 1}, {"items", {{"enum", question.words}}}};
      case KeyType::kIntegers: return {{"type", "array"}, {"minItems", 1}, {"items", numbers("integer", question)}};
      case KeyType::kNamedMaps:
        if (has_named_texts(outline_, question))
          return named(property(outline_.find(question.path())->cases[0].keys[0], {}));
        return named(mapping(path_within(question)));
      case KeyType::kNamedTexts: return named(property(named_text(outline_, question), {}));
      case KeyType::kIsThere:
      case KeyType::kIsMap: break;
    }
    return Json::object();
  }

  static Json numbers(const char* type, const KeyQuestion& question) {
    return {{"type", type}, {"minimum", number(question, question.low)}, {"maximum", number(question, question.high)}};
  }

  const Document& document_;
  const Outline& outline_;
};

}  // namespace

std::string json_schema(const Document& document, const Outline& outline) {
  return json::text_of(json::with_definitions(Schema(document, outline).whole())) + "\n";
}

std::string schema_file(const Document& document) { return document.kind + ".schema.json"; }

}  // namespace ttf::keys
