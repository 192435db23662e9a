// A document as pages for people and as a schema for editors.
#pragma once

#include <string>
#include <vector>

#include "keys/documents.h"
#include "keys/outline.h"

namespace ttf::keys {

struct Page {
  std::string file;  // "scenario.md"
  std::string text;
};

inline constexpr std::size_t kMostLines = 250;  // of a page

std::string text_of(const Document& document, const Outline& outline);
// The first page has all keys, or links to pages of their own for those that would make it too long.
std::vector<Page> markdown_pages(const Document& document, const Outline& outline);
// JSON Schema, draft 07. Parts that recur stand in its `$defs`. Times have no range in it, and a range that depends on other keys is the widest.
std::string json_schema(const Document& document, const Outline& outline);
std::string schema_file(const Document& document);  // "scenario.schema.json"

}  // namespace ttf::keys
