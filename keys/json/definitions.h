// A JSON Schema without repetitions, and its text.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace ttf::keys::json {

using Json = nlohmann::ordered_json;

inline constexpr std::size_t kWidth = 120;  // of a line

// Puts equal parts of a schema into `$defs`, once. "#/$defs/NAME" refers to one. A part that fits on a line stays. A
// definition is named after its first property. Further ones of that name have numbers. The schema is of draft 07.
Json with_definitions(Json schema);

// A value stands on one line if it fits. Otherwise each member has a line.
std::string text_of(const Json& value);

}  // namespace ttf::keys::json
