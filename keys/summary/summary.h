// The members of summary.json, for people and as a schema. `run` and `launch` describe what they write (table.h); the members
// with a number by which a drive is judged are rows of evaluation/measures/table.cc.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "keys/render.h"
#include "keys/summary/table.h"

namespace ttf::keys::summary {

inline constexpr std::string_view kKind = "summary";

// Returns the members of a strategy's part that are measures, with those that hold them.
std::vector<Member> measured();

// The same as of documents (render.h). `members` are all, in the order of the file.
std::string text(const std::vector<Member>& members);
std::vector<Page> pages(const std::vector<Member>& members);
Page schema(const std::vector<Member>& members);  // JSON Schema, draft 07

}  // namespace ttf::keys::summary
