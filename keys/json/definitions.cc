#include "keys/json/definitions.h"

#include <map>
#include <utility>

namespace ttf::keys::json {
namespace {

// Visits each schema directly within a schema. Its name is its property's, or else `name`.
template <typename Visit> void for_each_within(Json& schema, const std::string& name, const Visit& visit) {
  for (const char* of : {"properties", "patternProperties"})
    if (schema.contains(of))
      for (auto& [key, inner] : schema[of].items())
        if (inner.is_object()) visit(inner, schema[of].size() == 1 && key.starts_with('^') ? name : key);
  for (const char* of : {"additionalProperties", "items", "if", "then", "else", "not"})
    if (schema.contains(of) && schema[of].is_object()) visit(schema[of], name);
  for (const char* of : {"allOf", "anyOf"})
    if (schema.contains(of))
      for (Json& inner : schema[of]) visit(inner, name);
}

class Definitions {
 public:
  explicit Definitions(Json& schema) { count(schema, ""); }

  // Replaces all that stands more than once within a schema.
  void replace_within(Json& schema, const std::string& name) {
    for_each_within(schema, name, [&](Json& inner, const std::string& of) {
      const std::string text = inner.dump();
      if (times_[text] < 2 || text_of(inner).size() <= kWidth) return replace_within(inner, of);
      inner = {{"$ref", "#/$defs/" + name_of(text, inner, of)}};
    });
  }

  Json& all() { return all_; }

 private:
  // Parts of equal schemas count once: the definition has them once.
  void count(Json& schema, const std::string& name) {
    for_each_within(schema, name, [&](Json& inner, const std::string& of) {
      if (++times_[inner.dump()] == 1) count(inner, of);
    });
  }

  std::string name_of(const std::string& text, const Json& schema, const std::string& wanted) {
    if (const auto found = names_.find(text); found != names_.end()) return found->second;
    std::string name = wanted;
    for (int number = 2; all_.contains(name); ++number) name = wanted + "_" + std::to_string(number);
    names_[text] = name;
    all_[name] = nullptr;  // keeps the name: definitions within this one come behind it
    Json definition = schema;
    replace_within(definition, wanted);
    all_[name] = std::move(definition);
    return name;
  }

  std::map<std::string, int> times_;          // by the text of a schema
  std::map<std::string, std::string> names_;  // likewise
  Json all_ = Json::object();
};

// One line, with a blank behind each comma and colon.
std::string line_of(const Json& value) {
  if (!value.is_structured()) return value.dump();
  std::string line;
  for (const auto& [key, inner] : value.items()) {
    if (!line.empty()) line += ", ";
    if (value.is_object()) line += Json(key).dump() + ": ";
    line += line_of(inner);
  }
  return value.is_object() ? "{" + line + "}" : "[" + line + "]";
}

// `before`: the characters of the first line that stand before the value.
std::string lines_of(const Json& value, std::size_t depth, std::size_t before) {
  std::string line = line_of(value);
  if (!value.is_structured() || before + line.size() <= kWidth) return line;
  const std::string margin(depth + 1, ' ');
  std::string lines;
  for (const auto& [key, inner] : value.items()) {
    const std::string start = margin + (value.is_object() ? Json(key).dump() + ": " : "");
    lines += (lines.empty() ? "\n" : ",\n") + start + lines_of(inner, depth + 1, start.size());
  }
  lines += "\n" + std::string(depth, ' ');
  return value.is_object() ? "{" + lines + "}" : "[" + lines + "]";
}

}  // namespace

Json with_definitions(Json schema) {
  Definitions definitions(schema);
  definitions.replace_within(schema, "");
  if (!definitions.all().empty()) schema["$defs"] = std::move(definitions.all());
  return schema;
}

std::string text_of(const Json& value) { return lines_of(value, 0, 0); }

}  // namespace ttf::keys::json
