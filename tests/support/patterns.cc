#include "tests/support/patterns.h"

#include <regex>

namespace ttf::support {

struct Pattern::Compiled {
  std::regex regex;
};

namespace {

Match match_of(const std::smatch& found) {
  Match match{static_cast<std::size_t>(found.position()), static_cast<std::size_t>(found.length()), {}};
  match.groups.assign(found.begin(), found.end());
  return match;
}

}  // namespace

Pattern::Pattern(const char* expression) : Pattern(std::string(expression)) {}
Pattern::Pattern(const std::string& expression)
    : compiled_(std::make_shared<const Compiled>(Compiled{std::regex(expression)})) {}

bool found(const std::string& text, const Pattern& pattern) { return std::regex_search(text, (*pattern).regex); }

std::optional<Match> first_match(const std::string& text, const Pattern& pattern) {
  std::smatch found;
  if (!std::regex_search(text, found, (*pattern).regex)) return std::nullopt;
  return match_of(found);
}

std::optional<Match> whole_match(const std::string& text, const Pattern& pattern) {
  std::smatch found;
  if (!std::regex_match(text, found, (*pattern).regex)) return std::nullopt;
  return match_of(found);
}

std::vector<Match> matches(const std::string& text, const Pattern& pattern) {
  std::vector<Match> all;
  for (std::sregex_iterator at(text.begin(), text.end(), (*pattern).regex), end; at != end; ++at)
    all.push_back(match_of(*at));
  return all;
}

std::string replaced(const std::string& text, const Pattern& pattern, const std::string& by) {
  return std::regex_replace(text, (*pattern).regex, by);
}

std::string replaced_first(const std::string& text, const Pattern& pattern, const std::string& by) {
  return std::regex_replace(text, (*pattern).regex, by, std::regex_constants::format_first_only);
}

}  // namespace ttf::support
