// The six kinds of files that the program reads, each with the loader whose keys it has.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "keys/descriptions.h"
#include "keys/explore.h"
#include "keys/outline.h"

namespace ttf::keys {

// Descriptions of the keys below a path; "" is the whole file.
struct Chapter {
  std::string place;
  Descriptions rows;
  std::string when = "";  // as of a description, for all of them
};

struct Document {
  std::string kind;   // "scenario"
  std::string title;  // "A scenario"
  std::string about;  // a sentence: the purpose of the file
  Loader load;
  std::vector<Chapter> chapters;

  // Describes the key at `path`, in a case of its mapping. Returns null if there is no description.
  const Description* describe(const std::string& path, const std::vector<Condition>& conditions) const;
};

const std::vector<Document>& documents();

}  // namespace ttf::keys
