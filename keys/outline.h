// The keys of a kind of file, mapping by mapping, as exploring its loader showed them.
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "core/key_question.h"
#include "keys/explore.h"

namespace ttf::keys {

struct Key {
  KeyQuestion question;            // bounds: the widest that any other keys allow
  std::vector<std::string> words;  // a mapping that may be one of these words instead
  // Paths of the keys by which they change; a default that changes is the first one met.
  std::set<std::string> bounds_by, default_by;
};

// A key of the same mapping, or of the one around it, that decides which others there are.
struct Condition {
  enum class Of : unsigned char { kValue, kPresence };
  std::string key;
  Of of = Of::kValue;
  std::vector<std::string> values;  // any of them; of presence "true" or "false"
  bool usual = false;               // also where the key is absent
  bool around = false;              // a key of the mapping around this one
};

// The keys of a mapping under conditions that all hold.
struct Case {
  std::vector<Condition> conditions;
  std::vector<Key> keys;
};

struct Mapping {
  std::string path;         // "nodes.NAME", "frames[]"; empty: the whole file
  std::vector<Case> cases;  // at least one; without conditions there is no other
};

struct Outline {
  std::vector<Mapping> mappings;  // in the order in which the loader asked for them

  const Mapping* find(const std::string& path) const;
};

// A key that is a word or a mapping must not decide which other keys its own mapping has: no condition says that.
Outline outline(const Exploration& exploration);

}  // namespace ttf::keys
