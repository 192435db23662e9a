// A mistake for every rule: one change to a shipped file, and the finding it must cause.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>
#include <string>
#include <vector>

#include "tests/schedules/cluster_file.h"
#include "tests/support/patterns.h"

namespace ttf::schedules::check {

struct Wanted {
  std::string line;  // the file's line it points to contains this,
  std::string key;   // its key and value are these,
  std::string value;
  std::string words;  // and its expectation contains this
};

struct Mutation {
  std::string name;
  std::string pattern;      // its first match in the shipped file ...
  std::string replacement;  // ... becomes this
  Wanted wanted;            // in some finding
};

// The header of a node or task, up to a key inside it.
inline std::string inside(const std::string& outer, const std::string& key) {
  return "(\n *" + outer + ":[^~]*?" + key + ": )";
}

inline std::string line_of(const std::string& text, int number) {
  std::istringstream lines(text);
  std::string line;
  for (int n = 0; n < number; ++n)
    if (!std::getline(lines, line)) return "";
  return line;
}

inline void expect_named_in(const std::string& original, const std::vector<Mutation>& mutations) {
  ASSERT_TRUE(findings_of(original).empty()) << sentences(findings_of(original));
  for (const Mutation& mutation : mutations) {
    SCOPED_TRACE(mutation.name);
    const std::string text = support::replaced_first(original, mutation.pattern, mutation.replacement);
    ASSERT_NE(text, original) << "the pattern does not occur in the file";
    const Wanted& wanted = mutation.wanted;
    const auto findings = findings_of(text);
    const bool named = std::any_of(findings.begin(), findings.end(), [&](const Finding& finding) {
      return finding.file == "cluster.yaml" && finding.line > 0 && finding.key == wanted.key &&
             finding.value == wanted.value && finding.expected.find(wanted.words) != std::string::npos &&
             line_of(text, finding.line).find(wanted.line) != std::string::npos;
    });
    EXPECT_TRUE(named) << "wanted " << wanted.key << " = " << wanted.value << ": " << wanted.words << " at "
                       << wanted.line << sentences(findings);
  }
}

inline void expect_named(const std::vector<Mutation>& mutations, const std::string& shipped = "paper_unsynchronised") {
  expect_named_in(shipped_text(shipped), mutations);
}

}  // namespace ttf::schedules::check
