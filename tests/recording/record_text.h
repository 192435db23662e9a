// A sink that turns every record into one line of text, exact to the last bit of every number, to compare
// written and read records. Also draws records at random, with extreme values among them.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "recording/records/every.h"

namespace ttf::recording {

// Adds a line for every record to `lines`.
std::unique_ptr<records::Sink> text_into(std::vector<std::string>& lines);

class TextSink final : public records::Every<TextSink> {
 public:
  std::vector<std::string> lines;
  template <class Record> void each(const Record& record) { text_into(lines)->on(record); }
};

// The drawn fields' values. kSmallest and kLargest: every field at that end of its type, lists empty and
// long. kDrawn: any values, with times near `at`.
enum class Values { kSmallest, kLargest, kZero, kDrawn };

// One record of `kind` (1 to records::kKindCount), a pure function of the arguments, to `sink`.
void emit(records::Sink& sink, int kind, Values values, std::uint32_t index, std::int64_t at_ns);

}  // namespace ttf::recording
