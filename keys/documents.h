// The five kinds of files that the program reads, each with the loader whose keys it has.
#pragma once

#include <string>
#include <vector>

#include "keys/descriptions.h"
#include "keys/explore.h"
#include "keys/outline.h"

namespace ttf::keys {

// Descriptions of what lies below a path; "" is the whole file.
struct Chapter {
  std::string place;
  Descriptions rows;
};

struct Document {
  std::string kind;   // "scenario"
  std::string title;  // "A scenario"
  std::string about;  // a sentence: what the file is for
  Loader load;
  std::vector<Chapter> chapters;

  // Of the key at `path` in a case of its mapping; null where there is none.
  const Description* describe(const std::string& path, const std::vector<Condition>& conditions) const;
};

const std::vector<Document>& documents();
const Document* document_of(const std::string& kind);  // null where there is none

}  // namespace ttf::keys
