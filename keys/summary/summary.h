// summary.json, which `run` and `launch` write: every member with its meaning, for people and as a schema. The members with
// a number by which a drive is judged are rows of evaluation/measures/table.cc.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "keys/render.h"

namespace ttf::keys::summary {

inline constexpr std::string_view kKind = "summary";

struct Member {
  std::string path;     // "strategies[].nees.mean"; [] stands for each entry of a list, NAME for any name
  std::string type;     // a type of JSON; "number or null"
  std::string meaning;  // a sentence without its full stop, with the unit
  bool optional = false;
};

// In the order of the file.
std::vector<Member> members();

// The same as of documents (render.h).
std::string text();
std::vector<Page> pages();
Page schema();  // JSON Schema, draft 07

}  // namespace ttf::keys::summary
