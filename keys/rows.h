// Every key of a document in one list, mapping after mapping, for tables.
#pragma once

#include <string>
#include <vector>

#include "keys/documents.h"
#include "keys/outline.h"

namespace ttf::keys {

struct Row {
  std::string path;
  Key key;
  std::string only_with;                     // the condition in words; empty: always
  const Description* description = nullptr;  // null: not described
  bool may_be_alike = false;                 // `like` of the same mapping may supply the value
};

// The keys of a mapping come in the order in which the loader asks for them, each before the keys within it.
std::vector<Row> rows_of(const Document& document, const Outline& outline);

// An entry with this key has another's value for each key that it lacks. Whether the entries may have it:
inline constexpr const char* kLike = "like";
bool may_be_alike(const std::vector<Case>& cases);

// The path of the mapping within a key: of its entries where it has several; empty where it has no mapping.
std::string path_within(const KeyQuestion& question);
// The key that stands for the entries of named texts, as the loader reads them.
Key named_text(const Outline& outline, const KeyQuestion& question);
// Whether the entries of named mappings are named texts themselves.
bool has_named_texts(const Outline& outline, const KeyQuestion& question);

}  // namespace ttf::keys
