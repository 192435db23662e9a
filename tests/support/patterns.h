// Regular expressions (ECMAScript's) over texts. The compiler needs seconds for std::regex in each source, and tests would run
// it unoptimised: one library has it for all tests.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace ttf::support {

// An expression, compiled once. The functions below take its text, too; a loop keeps a Pattern.
class Pattern {
 public:
  struct Compiled;
  Pattern(const char* expression);         // NOLINT(google-explicit-constructor)
  Pattern(const std::string& expression);  // NOLINT(google-explicit-constructor)
  const Compiled& operator*() const { return *compiled_; }

 private:
  std::shared_ptr<const Compiled> compiled_;
};

struct Match {
  std::size_t at = 0, size = 0;     // in the text
  std::vector<std::string> groups;  // the match, then the groups of its pattern; empty for a group that took no part
  const std::string& operator[](std::size_t group) const { return groups.at(group); }
};

bool found(const std::string& text, const Pattern& pattern);
std::optional<Match> first_match(const std::string& text, const Pattern& pattern);
std::optional<Match> whole_match(const std::string& text, const Pattern& pattern);
std::vector<Match> matches(const std::string& text, const Pattern& pattern);

// Return the text with each match replaced, or with the first one; `by` names groups as $1.
std::string replaced(const std::string& text, const Pattern& pattern, const std::string& by);
std::string replaced_first(const std::string& text, const Pattern& pattern, const std::string& by);

}  // namespace ttf::support
