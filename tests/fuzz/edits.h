// Edits of a shipped YAML file: nearly correct inputs that pass the parser. Their form is short, readable,
// and survives changes of the file.
//
//   paper_synchronised          first line: which of the shipped files, by its name (the first one, if unknown)
//   gdStaticSlot 0 12           the value after the first "gdStaticSlot:" is 12
//   - period 1                  the line with the second "period:" is dropped
//   + period 1                  it is there twice
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace ttf::fuzz {

struct Shipped {
  std::string name;  // without folder and extension
  std::string text;
};

// Edits that find no place are without effect.
std::string edited(std::span<const Shipped> files, std::string_view edits);

}  // namespace ttf::fuzz
